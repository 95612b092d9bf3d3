"""The arm to export, and what must be said of it: numbers that no reading determined, and what does not go along."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ulna.arm.arm import Arm
from ulna.formats.toml import read_json
from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class Source:
    """An arm read for export."""

    arm: Arm
    remarks: list[str]
    """What the user should know of the numbers."""


def read_source(path: Path, what: str, has_base: bool) -> Source:
    """An arm.toml or a result.json, to be written as `what` ("a URDF"). Raises UlnaInputError.

    has_base: whether that says where the first axis stands."""
    arm = Arm.load(path)
    for k, joint in enumerate(arm.joints, start=1):
        if joint.sign not in (1, -1):
            raise UlnaInputError(
                f"{path}: key 'joint.{k}.sign': got {joint.sign}; expected 1 or -1 of an arm that is written as {what}."
                " Calibrate first, and export the result."
            )
    remarks = remarks_of_result(path)
    left_out = not_carried(arm, has_base)
    if left_out:
        remarks.append(remark_not_carried(left_out, what, path))
    return Source(arm, remarks)


def remarks_of_result(path: Path) -> list[str]:
    """Of a result.json: that its fit failed, and which parameters its readings did not determine. None of an arm file.

    Whatever is damaged in these parts says nothing; the arm itself was checked when it was read.
    """
    if path.suffix.lower() != ".json":
        return []
    document = read_json(path, "a result.json")[0]
    remarks = []
    fit, rows = document.get("fit"), document.get("parameters")
    if isinstance(fit, dict) and fit.get("converged") is False:
        remarks.append(f"{path}: the fit did not converge ({fit.get('termination')}): do not use these numbers.")
    lost = [
        str(row.get("name"))
        for row in (rows if isinstance(rows, list) else [])
        if isinstance(row, dict) and row.get("status") == "not-determined"
    ]
    if lost:
        whose = "them" if len(lost) > 1 else "it"
        remarks.append(
            f"{path}: the readings did not determine {', '.join(lost)}; what they left open of {whose} is "
            "as the calibration started. 'identifiability' in the result says why, and what would help."
        )
    return remarks


def not_carried(arm: Arm, has_base: bool) -> list[str]:
    """What an arm has beyond rigid links and turning joints, in words: neither a URDF nor a table carries it, but for
    where the first axis stands."""
    return [effect.words for effect in arm.effects if not (has_base and effect.of_first)]


def remark_not_carried(left_out: list[str], what: str, path: Path) -> str:
    """The remark on it."""
    return (
        f"{path}: {what} has no place for {', '.join(left_out)}: the tips of what is written differ from the arm's by "
        "that. Correct the angles in your program, or calibrate without them."
    )


def chosen_probe(arm: Arm, name: str | None, path: Path) -> str:
    """The probe asked for, or the only one. Raises UlnaInputError with the names that there are."""
    if name is None and len(arm.probes) > 1:
        raise UlnaInputError(
            f"{path}: the arm has {len(arm.probes)} probes ({', '.join(arm.probes)}); expected one that ends in the "
            "tip link. Say which with --probe."
        )
    return list(arm.probes)[arm.probe_index(name)]
