"""The arm as everybody above uses it: what it is, and the door to its files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from ulna.arm.data import ArmData
from ulna.arm.file import arm_of_result, load_arm, save_arm


@dataclass(frozen=True)
class Arm(ArmData):
    """An articulated arm: joints from the base to the probe, and the probes it can carry. Immutable."""

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read an arm file (`ulna-arm/1`, TOML) or the arm of a result (`result.json`). Raises UlnaInputError."""
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

    def save(self, path: str | Path, force: bool = False) -> None:
        """Write an arm file in mm and rad. Raises UlnaInputError where the file exists and `force` is not given."""
        save_arm(self, Path(path), force=force)
