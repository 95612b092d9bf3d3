"""The arm as everybody above uses it: what it is, and the door to its files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Self

from ulna.arm.about import about_arm
from ulna.arm.data import ArmData
from ulna.arm.file import arm_of_result, load_arm, save_arm
from ulna.ground.provided import provided
from ulna.ground.shown import About, Shown


@dataclass(frozen=True, repr=False)
class Arm(Shown, ArmData):
    """An articulated arm: joints from the base to the probe, and the probes it can carry. Immutable."""

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read an arm file (`ulna-arm/1`, TOML) or the arm of a result (`result.json`, or the folder with it). Raises
        UlnaInputError."""
        return cls.load_and_hash(path)[0]

    @classmethod
    def load_and_hash(cls, path: str | Path) -> tuple[Self, str]:
        """The same, with the SHA-256 of the bytes that were read."""
        return load_arm(Path(path), cls)

    @classmethod
    def of_result(cls, document: dict[str, Any], path: Path) -> Self:
        """The calibrated arm of a result document that was read from `path`, with what is known of its parameters.
        Raises UlnaInputError."""
        return arm_of_result(document, path, cls)

    @classmethod
    def from_urdf(
        cls,
        path: str | Path,
        *,
        tip_link: str | None = None,
        base_link: str | None = None,
        length_unit: Literal["mm", "m", "in"] | None = None,
        angle_unit: Literal["rad", "deg"] | None = None,
    ) -> Arm:
        """The arm that a robot's drawing (URDF) describes, with one probe `ball` at the tip link.

        tip_link: the link whose origin is the ball, base_link: the one that the arm stands on, where they are not the
        ends of the longest chain. length_unit, angle_unit: of a drawing that is not in m and rad. Warns with
        InputWarning of what is left out, and of a base frame that is not the drawing's. Raises UlnaInputError.
        """
        arm: Arm = provided("arm of a URDF")(Path(path), tip_link, base_link, length_unit, angle_unit)
        return arm

    @classmethod
    def from_dh(
        cls,
        table: Any,
        *,
        convention: Literal["dh", "modified-dh"],
        length_unit: Literal["mm", "m", "in"] | None = None,
        angle_unit: Literal["rad", "deg"] | None = None,
        tip: Sequence[float] | None = None,
        name: str | None = None,
    ) -> Arm:
        """The arm that a table of Denavit–Hartenberg parameters describes: a row for each joint, from the base.

        table: the path of one, a DataFrame, an Arrow table, a dict of arrays, a list of dicts, or rows of four
        numbers in the order theta0, d, a, alpha. Columns theta0 (or offset, which is -theta0), d, a, alpha; perhaps
        beta, sign, joint, name. convention: whether a row's alpha and a stand behind its joint ("dh") or before it
        ("modified-dh"). Units are in the columns' names (`a_mm`, `alpha_deg`), else stated; never guessed. tip: of the
        probe, in the last row's frame, in the table's unit of length; without it the origin of that frame. Warns with
        InputWarning of how it was written otherwise. Raises UlnaInputError; TypeError for what is no table.
        """
        arm: Arm = provided("arm of a DH table")(table, convention, length_unit, angle_unit, tip, name)
        return arm

    def save(self, path: str | Path, force: bool = False) -> None:
        """Write an arm file in mm and rad. Raises UlnaInputError where the file exists and `force` is not given."""
        save_arm(self, Path(path), force=force)

    def about(self) -> About:
        """What it is: joints, probes, what is known of them."""
        return about_arm(self)
