"""Sizes that do not agree with the arm, in words: lengths off the arm file by one factor, lengths beyond any reach."""

from __future__ import annotations

from ulna.arm.effects.effects import extra_of
from ulna.calibration.result import Result
from ulna.ground.digits import figure_mm

#: of which unit a length was, if it was taken for another one: how many times that one
_UNITS = {
    25.4: ("inches", "millimetres"),
    1000.0: ("metres", "millimetres"),
    10.0: ("centimetres", "millimetres"),
    304.8: ("feet", "millimetres"),
}
#: a factor so near a unit's is the unit's, in parts
_ALIKE = 0.05
#: so many artefacts are named
_MOST = 3


def common_factor(result: Result) -> str:
    """ "Every length of the arm came out 18 % shorter …: is the length of artefact 'bar' right?", or nothing."""
    factor = result.fit.common_factor
    if factor is None:
        return ""
    names = list(dict.fromkeys(placement.artefact for placement in result.artefacts))
    stated = f"of artefact {', '.join(repr(name) for name in names)}" if len(names) <= _MOST else "of the artefacts"
    return (
        f"Every length of the arm came out {times(factor)} than in the arm file: is the size that is stated {stated} "
        f"right, and are the lengths in the arm file?{_taken_for(factor)} Readings of lengths cannot tell: they fit "
        "either way."
    )


def beyond_reach(result: Result) -> str:
    """A stated size that an arm as drawn cannot span, in words, or nothing: no length is more than twice the reach."""
    off_mm = max(map(abs, result.before.values()), default=0.0)
    reach_mm = _reach_mm(result)
    if off_mm < 2.0 * reach_mm:
        return ""
    return (
        f"Before the fit readings were off by up to {figure_mm(off_mm)} mm, and the arm of the arm file reaches no "
        f"farther than {reach_mm:.0f} mm from its base: is a stated size in another unit?"
    )


def _reach_mm(result: Result) -> float:
    """All lengths of the arm file one after the other."""
    rows = [row for row in result.parameters if row.unit == "mm" and extra_of(row.name) is None]
    return sum(abs(row.start) for row in rows if not row.name.startswith("artefact."))


def times(factor: float) -> str:
    """How much longer or shorter, in words; factor: found over drawn, of any sign."""
    longer, size = factor > 1.0, abs(factor)
    word = "longer" if longer else "shorter"
    if 0.5 <= size <= 2.0:
        return f"{abs(size - 1.0) * 100.0:.3g} % {word}"
    if size < 1e-3:
        return "more than a thousand times shorter"
    size = size if longer else 1.0 / size
    return f"{size:.0f} times {word}" if size >= 100.0 else f"{size:.3g} times {word}"


def _taken_for(factor: float) -> str:
    for many, (large, small) in _UNITS.items():
        if abs(abs(factor) * many - 1.0) < _ALIKE:
            return f" It looks as if {large} were stated as {small}."
        if abs(abs(factor) / many - 1.0) < _ALIKE:
            return f" It looks as if {small} were stated as {large}, or the arm's lengths in {large} as {small}."
    return ""
