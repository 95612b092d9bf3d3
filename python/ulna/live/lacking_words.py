"""What touches do not tell yet, and what they never will, in a few lines of a screen."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence

from ulna.arm.causes import said_of
from ulna.arm.directions import sentence, steps, worth_naming
from ulna.ground.worded import worded
from ulna.live.lacking import Direction, Lacking

LINES = 6
"""On a screen that must not jump."""
NAMED = 2
"""Parameters that are named of those that take part."""
OF_JOINT: dict[str, Callable[[str], str]] = {
    "theta0": lambda joint: worded("zero of joint {joint}", joint=joint),
    "alpha": lambda joint: worded("twist of joint {joint}", joint=joint),
    "a": lambda joint: worded("length of joint {joint}", joint=joint),
    "d": lambda joint: worded("offset of joint {joint}", joint=joint),
    "beta": lambda joint: worded("tilt of joint {joint}", joint=joint),
}
"""Parameters as docs/concepts/model.md calls them."""


def lacking_lines(found: Lacking, columns: int = 80, most: int = LINES) -> list[str]:
    """The most important, whole sentences, at most so many lines; how many there are more."""
    said = list(_sentences(found))
    lines: list[str] = []
    for number, text in enumerate(said):
        own = textwrap.wrap(text, columns, subsequent_indent="  ", break_on_hyphens=False)
        last = number + 1 == len(said)
        if len(lines) + len(own) + (not last) > most:
            # never silent: that there is more is said where it does not fit
            rest = len(said) - number
            return [*lines, f"… and {rest} more {'cause' if rest == 1 else 'causes'}: --json has all."]
        lines += own
    return lines


def named_of(directions: Sequence[Direction]) -> str:
    """Those parameters that take the largest steps, "zero of joint 6 with x of probe bent and 3 more"."""
    largest: dict[str, float] = {}
    for direction in directions:
        weights: Mapping[str, float] = direction["combination"]
        sizes = steps(worth_naming(weights))
        whole = max(sizes.values())
        for name, size in sizes.items():
            # of each direction what it moves most counts alike
            largest[name] = max(largest.get(name, 0.0), size / whole)
    ordered = sorted(largest, key=lambda name: -largest[name])
    more = len(ordered) - NAMED
    named, *second = map(in_words, ordered[:NAMED])
    for other in second:
        named = worded("{one} with {other}", one=named, other=other)
    return worded("{some} and {count} more", some=named, count=more) if more > 0 else named


def in_words(parameter: str) -> str:
    """ "zero of joint 6"; what has no word keeps its name."""
    what, _, rest = parameter.partition(".")
    of, _, key = rest.rpartition(".")
    if what == "joint" and key in OF_JOINT:
        return OF_JOINT[key](of)
    return worded("{key} of probe {probe}", key=key, probe=of) if what == "probe" else parameter


def _sentences(found: Lacking) -> Iterator[str]:
    """What no length depends on is left out: nobody must do anything about it."""
    lost_for_good = [each for each in found.never if not each["frame"]]
    for head, directions in (
        ("Never by touching this", lost_for_good),
        ("Not known yet", found.not_yet),
        ("Hardly known", found.weak),
    ):
        for because, remedy, own in together(directions):
            count = f" ({len(own)} combinations)" if len(own) > 1 else ""
            yield f"{head}{count}: {named_of(own)}: {because}. {sentence(remedy[:1].upper() + remedy[1:])}"


def together(directions: Sequence[Direction]) -> Iterator[tuple[str, str, list[Direction]]]:
    """Those with the same cause and remedy, once."""
    groups: dict[tuple[str, str], list[Direction]] = {}
    for direction in directions:
        groups.setdefault((str(direction["because"]).rstrip("."), str(direction["remedy"])), []).append(direction)
    for (because, remedy), own in groups.items():
        yield said_of(because), said_of(remedy), own
