"""The models that are tried: geometry alone, with its drawing, every block that a study allows, with and without, and
a ladder of harmonics' orders.

Amplitudes of harmonics are known beforehand to be small: those of order k to u √(1/k² + c²). The first part is of discs
off their centre, which fades with the order, the second of gears, which does not. Two c are tried. u, and that of the
other blocks' parameters, is the one with which the readings are likeliest (`ulna.calibration.choosing.widths`). What a
study itself states of them is kept.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations

from ulna.arm.effects.effects import EFFECTS
from ulna.ground.errors import UlnaInputError
from ulna.study.assembly import assemble
from ulna.study.options import with_options
from ulna.study.parameters import start_arm, without_vain
from ulna.study.study import Study

LADDER = (1, 2, 4, 10, 20, 40)
"""Highest orders tried."""
HARMONICS = "encoder-harmonics"
"""The block whose orders are a ladder."""
FALLS = (0.1, 0.4)
"""c of the law."""
TIMES = (1.0, 0.1)
"""How well makers keep to lengths differs tenfold; where places are few it matters which it is."""
MOST_SUBSETS_OF = 3
"""Of more blocks each alone, all, and all but each are tried, not every subset."""


@dataclass(frozen=True)
class Model:
    """One to try."""

    blocks: tuple[str, ...] = ()
    """Beside harmonics."""
    order: int = 0
    """Highest; 0: no harmonics."""
    fall: float | None = None
    """c of the law; None: alike for all orders."""
    drawn: bool = True
    """Whether it knows how well arms keep to drawings."""
    lengths: float = 1.0
    """How well lengths of links are known from it: times as far as any."""
    stated: frozenset[str] = frozenset()
    """Blocks of which the study says what is known beforehand, or of which nothing is; of others it is learned."""

    @property
    def extras(self) -> list[str]:
        """As a study asks for it."""
        return ([HARMONICS] if self.order else []) + list(self.blocks)


def without_harmonics(blocks: Sequence[str], stated: frozenset[str]) -> list[Model]:
    """Geometry alone first, then each subset of the blocks with lengths known well and very well."""
    return [
        Model(drawn=False),
        *(Model(chosen, lengths=times, stated=stated) for chosen in _subsets(blocks) for times in TIMES),
    ]


def with_harmonics(blocks: Sequence[str], lengths: float, stated: frozenset[str]) -> list[Model]:
    """Each subset of the blocks with the ladder."""
    falls: Sequence[float | None] = (None,) if HARMONICS in stated else FALLS
    return [
        Model(chosen, order, fall, lengths=lengths, stated=stated)
        for chosen in _subsets(blocks)
        for order in LADDER
        for fall in (falls if order > 1 else (None,))
    ]


def _subsets(blocks: Sequence[str]) -> list[tuple[str, ...]]:
    sizes: Iterable[int] = range(len(blocks) + 1)
    if len(blocks) > MOST_SUBSETS_OF:
        sizes = (0, 1, len(blocks) - 1, len(blocks))
    return [chosen for size in sizes for chosen in combinations(blocks, size)]


def allowed(study: Study) -> tuple[list[str], dict[str, str]]:
    """Blocks beside harmonics that the study's arm and readings allow together, and why not the others."""
    found: list[str] = []
    impossible = {}
    for name in EFFECTS:
        if name == HARMONICS:
            continue
        if EFFECTS[name].of_first and not any(each.artefact.frame == "arm" for each in study.readings):
            impossible[name] = "no artefact's coordinates are stated in the arm's base frame (frame = \"arm\")"
            continue
        try:
            assemble(asking(study, [*found, name], [1]))
        except UlnaInputError as error:
            impossible[name] = str(error).removeprefix(f"{study.label}: ")
        else:
            found.append(name)
    return found, impossible


def asking(study: Study, extras: Sequence[str], orders: Sequence[int]) -> Study:
    """The study with these blocks, without what it says of blocks that it then has not. Raises UlnaInputError."""
    asked = with_options(study, extras=list(extras), harmonics=list(orders), auto=False)
    return dataclasses.replace(asked, fit=without_vain(asked, start_arm(asked).parameter_names))
