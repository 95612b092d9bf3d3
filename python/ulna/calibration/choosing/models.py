"""The models that are tried: every block that a study allows, with and without, and a ladder of harmonics' orders.

Amplitudes of harmonics are known beforehand to be small: those of order k to u √(1/k² + c²). The first part is of discs
off their centre, which fades with the order, the second of gears, which does not. Two c are tried; u is the one with
which the readings are likeliest (`ulna.calibration.choosing.widths`), or the one that any fit has. What a study itself
states of them is kept.
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
USUAL_MOST = 4
"""Up to this order the prior that any fit has is tried as well: beyond, it lets too much through."""
MOST_SUBSETS_OF = 3
"""Of more blocks each alone, all, and all but each are tried, not every subset."""


@dataclass(frozen=True)
class Width:
    """What is known beforehand of harmonics' amplitudes."""

    fall: float | None
    """c of the law; None: alike for all orders."""
    learned: bool
    """Whether u is learned from the readings; else it is as any fit has it, or as the study states it."""


WIDTHS = (Width(0.1, True), Width(0.4, True), Width(None, False))


@dataclass(frozen=True)
class Model:
    """One to try."""

    blocks: tuple[str, ...]
    """Beside harmonics."""
    order: int = 0
    """Highest; 0: no harmonics."""
    width: Width | None = None

    @property
    def extras(self) -> list[str]:
        """As a study asks for it."""
        return ([HARMONICS] if self.order else []) + list(self.blocks)


def models_of(blocks: Sequence[str], most_order: int, stated: bool) -> list[Model]:
    """All to try. stated: whether the study says itself what is known of the amplitudes."""
    found = []
    for chosen in _subsets(blocks):
        found.append(Model(chosen))
        for order in (order for order in LADDER if order <= most_order):
            widths = [Width(None, False)] if stated else [w for w in WIDTHS if w.learned or order <= USUAL_MOST]
            found += [Model(chosen, order, width) for width in widths]
    return found


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
