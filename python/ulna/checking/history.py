"""Earlier checks: files, or folders of them, of the same protocol and of the arm as it is calibrated now."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np

from ulna.checking.result_file import CheckedTable, CheckFile, load_check
from ulna.formats.toml import read_json
from ulna.ground.arrays import F64, Bool
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import templates, worded
from ulna.verification.outcome import Labels
from ulna.verification.touches import Touches

WHAT = "earlier checks (JSON), or a folder of them"
DAY_S = 86400.0

NOT_USED = "history: {count} checks are {why}: not used."
ONE_NOT_USED = "history: 1 check is {why}: not used."
NO_CHECK = "history: {path}: there is no check in it."
SAME = "of the same readings as another one"
LATER = "not earlier than this one"
BEFORE = "of the arm before it was calibrated as it is now"
REMARKS = templates(NOT_USED, ONE_NOT_USED, NO_CHECK, SAME, LATER, BEFORE)
"""Templates of what is remarked on earlier checks."""


@dataclass(frozen=True)
class Earlier:
    """One of them."""

    path: Path
    sha256: str
    time: datetime
    file: CheckFile

    @property
    def readings(self) -> list[str]:
        """SHA-256 of each table of readings."""
        return [each.sha256 for each in self.file.provenance.files]

    @property
    def arm(self) -> list[str | None]:
        """SHA-256 of the arm that made points of each."""
        return [each.arm_sha256 for each in self.file.provenance.files]


def load_history(
    paths: Iterable[str | os.PathLike[str]], name: str, arm: str, touches: Touches, time: datetime, remarks: list[str]
) -> list[Earlier]:
    """Those that the check of these touches can be judged by, in order of time.

    name, arm: of protocol and arm; a file of another one is an error, for somebody named it. What is of the arm as it
    was calibrated otherwise, of the same readings, or later, is not used, with a remark. Raises UlnaInputError.
    """
    found = [each for path in paths for each in _in(Path(path), remarks)]
    for each in found:
        for what, mine, theirs in (("protocol", name, each.file.protocol.name), ("arm", arm, each.file.arm)):
            if mine != theirs:
                raise UlnaInputError(
                    f"{each.path}: it is a check of the {what} '{theirs}', this one is of '{mine}'; expected earlier "
                    "checks of the same. Name those."
                )
    kept: list[Earlier] = []
    seen = {touches.sha256}
    left: dict[str, int] = {}
    for each in sorted(found, key=lambda each: each.time):
        why = None
        if any(digest in seen for digest in each.readings):
            why = worded(SAME)
        elif each.time >= time:
            why = worded(LATER)
        elif any(digest != touches.arm_sha256 for digest in each.arm):
            why = worded(BEFORE)
        seen.update(each.readings)
        if why is None:
            kept.append(each)
        else:
            left[why] = left.get(why, 0) + 1
    remarks += [
        worded(NOT_USED, count=count, why=why) if count > 1 else worded(ONE_NOT_USED, why=why)
        for why, count in left.items()
    ]
    return kept


def _in(path: Path, remarks: list[str]) -> list[Earlier]:
    if not path.is_dir():
        file, time, digest = load_check(path)
        return [Earlier(path, digest, time, file)]
    inside = sorted(each for each in path.glob("*.json") if each.is_file())
    checks = [each for each in inside if str(read_json(each, WHAT)[0].get("format")).startswith("ulna-check/")]
    if not checks:
        remarks.append(worded(NO_CHECK, path=str(path)))
    return [one for each in checks for one in _in(each, remarks)]


@dataclass(frozen=True)
class Past:
    """One figure in one place, of N earlier checks in order of time."""

    values_mm: F64
    """(N,)"""
    days: F64
    """(N,) since 1970."""
    well: Bool
    """(N,) whether nothing was out of control; else no baseline rests on it."""
    not_used: int
    """Of further checks, in which it was out by itself: beyond its limit, or far from what it was. Somebody looked into
    that; it says nothing of how the arm is."""


def past(earlier: Sequence[Earlier], test: str, key: str, labels: Labels) -> Past:
    """Of those checks that have it."""
    values, days, well, not_used = [], [], [], 0
    for each in earlier:
        figure = next((one for one in each.file.figures if _is(one, test, key, labels)), None)
        if figure is None:
            continue
        signals = [] if figure.history is None else figure.history.signals
        if figure.verdict == "fail" or not all(signal.slow for signal in signals):
            not_used += 1
            continue
        values.append(figure.value)
        days.append(each.time.timestamp() / DAY_S)
        well.append(not signals)
    return Past(np.array(values, dtype=np.float64), np.array(days, dtype=np.float64), np.array(well, bool), not_used)


def _is(figure: CheckedTable, test: str, key: str, labels: Labels) -> bool:
    return (figure.test, figure.key, figure.of) == (test, key, labels.as_dict())
