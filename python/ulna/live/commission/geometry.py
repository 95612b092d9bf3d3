"""The geometry to begin with, which no turning of joints tells: a drawing's, or a guess from how far the arm reaches.

A device may tell it too. With it comes in which direction each joint counts as positive.
"""

from __future__ import annotations

from pathlib import Path

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.registry import device_arm
from ulna.live.source_file import read_source
from ulna.proposals.answers import Answers
from ulna.proposals.arms import Drawn, by_reach, drawn_arm

REACH_MM = 1000.0
"""Of an arm of which nobody has said it: a length to be replaced."""


def geometry(arm: Path | None, joints: int | None, reach_mm: float | None, source: str | None = None) -> Drawn:
    """An arm file, a result or a URDF, else what the source's device tells of itself, else as `ulna new` draws an arm.

    Raises UlnaInputError where neither says how many joints there are, or both do and differ.
    """
    if arm is None:
        told = None if source is None or reach_mm is not None else device_arm(read_source(source))
        if told is not None:
            if joints not in (None, told.arm.n):
                raise UlnaInputError(f"--joints: got {joints}, but {source} has {told.arm.n}. Leave it out.")
            return told
        if joints is None:
            raise UlnaInputError("--joints is missing; expected how many joints the arm has. Give it, or --arm.")
        return by_reach(joints, REACH_MM if reach_mm is None else reach_mm, ["none"], "arm")
    if reach_mm is not None:
        raise UlnaInputError(
            f"--reach: got {reach_mm:g}, but {arm} draws the arm; expected one of them. Leave one out."
        )
    answers = Answers(urdf=arm) if arm.suffix.lower() in (".urdf", ".xml") else Answers(arm=arm)
    drawn = drawn_arm(answers)
    assert isinstance(drawn, Drawn)
    drawn.arm.check_turns(arm, "commissionings")
    if joints not in (None, drawn.arm.n):
        raise UlnaInputError(f"--joints: got {joints}, but {arm} has {drawn.arm.n}. Correct one of them.")
    return drawn


def ways(drawn: Drawn, source: str) -> list[str | None]:
    """Of each joint, in words, how it is turned so that it counts as positive: anticlockwise, looked at from the end of
    its z axis (docs/concepts/conventions.md). Of a guessed arm that is known of the first axis alone.

    source: what draws the arm, by name.
    """
    upright = worded("anticlockwise, seen from {side}", side=worded("above"))
    if drawn.guessed:
        return [upright, *[None] * (drawn.arm.n - 1)]
    seen = worded("anticlockwise, seen from the end of its z axis as {source} draws it", source=source)
    return [worded("{seen} (from above, if the arm stands upright)", seen=seen), *[seen] * (drawn.arm.n - 1)]
