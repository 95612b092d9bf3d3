"""What readings do not tell of the signs of encoders: which make the arm its mirror image, and which are only another
way to write the same arm; a line each on a screen, with what to do about it under `--all`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rich.console import RenderableType
from rich.text import Text

from ulna.calibration.summary import FitSummary

#: sets of joints that are each named in a line, and with `--all`
_FEW, _MOST = 3, 12

Sets = Sequence[Sequence[int]]


def signs_in_lines(fit: FitSummary, width: int) -> list[RenderableType]:
    """A line of `width` columns at most for the mirror image, and one for the same arm written differently."""
    said: list[RenderableType] = []
    if fit.mirrored_signs:
        deciding = decide(fit)
        asked = "x, y, z may be mirror-imaged"
        said.append(
            _longest(
                width,
                f"{asked}: the sign of {_one_of(deciding)} decides. How to find it: --all",
                f"{asked}: the sign of {_one_of(deciding)} decides (--all)",
                f"{asked} ({_one_of(deciding)} decides: --all)",
                f"{asked} ({_one_of(deciding)}: --all)",
                f"{asked}: the sign of 1 of {len(deciding)} joints decides (--all)",
                f"{asked}: what decides: --all",
            )
        )
    same = _same(fit)
    if same:
        said.append(
            _longest(
                width,
                f"The same arm, written differently: {_counting(same, _FEW)} the other way.",
                f"The same arm, written in {len(same) + 1} ways: signs of {_every(same)} (--all)",
                f"The same arm, written in {len(same) + 1} ways: --all",
            )
        )
    return said


def signs_in_full(fit: FitSummary) -> list[RenderableType]:
    """The same with each set, and how the mirror image is told from the arm."""
    said: list[RenderableType] = []
    if fit.mirrored_signs:
        said.append(
            Text(
                "x, y and z may be mirror-imaged: these readings do not tell this arm from its mirror image, in which "
                f"{_counting(fit.mirrored_signs, _MOST)} the other way. To decide, turn "
                f"{_one_of(decide(fit))} counter-clockwise, looked at from the end of its z axis in the "
                "arm file: with sign = 1 its count rises. State that sign and calibrate again."
            )
        )
    same = _same(fit)
    if same:
        said.append(Text(f"The same arm, written differently: {_counting(same, _MOST)} the other way."))
    return said


def decide(fit: FitSummary) -> list[int]:
    """Joints whose sign tells the arm from its mirror image: those that count the other way in every mirror image and
    in no other way to write the arm, of which one is enough; where there is none, those in any mirror image."""
    shared = set(fit.mirrored_signs[0]).intersection(*fit.mirrored_signs[1:])
    return sorted(shared.difference(_members(_same(fit)))) or _members(fit.mirrored_signs)


def _same(fit: FitSummary) -> Sets:
    return [joints for joints in fit.undecided_signs if joints not in fit.mirrored_signs]


def _members(sets: Sets) -> list[int]:
    return sorted({joint for joints in sets for joint in joints})


def _counting(sets: Sets, most: int) -> str:
    """Which joints count, in words: "joints 1 and 3, or joint 7 count"; of many sets, which joints are in any."""
    if len(sets) > most:
        return f"some of {_every(sets)} ({len(sets)} choices, each with its own twists) count"
    said = [f"joint{'s' * (len(joints) > 1)} {_listed(joints, 'and')}" for joints in sets]
    return f"{', or '.join(said)} {'counts' if len(sets[-1]) == 1 else 'count'}"


def _every(sets: Sets) -> str:
    joints = _members(sets)
    return f"joint{'s' * (len(joints) > 1)} {_listed(joints, 'and')}"


def _one_of(joints: Iterable[int]) -> str:
    return f"joint {_listed(joints, 'or')}"


def _listed(numbers: Iterable[int], word: str) -> str:
    *most, last = [str(number) for number in numbers]
    return f"{', '.join(most)} {word} {last}" if most else last


def _longest(width: int, *wordings: str) -> Text:
    """The first that fits into one line, else the last."""
    fitting = (words for words in wordings if len(words) <= width)
    return Text(next(fitting, wordings[-1]))
