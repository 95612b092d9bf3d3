"""What places that were held out say of the arm that was fitted to the others."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.artefacts.quantities import QUANTITIES
from ulna.calibration.coverage import P
from ulna.cli.printed.coverage import coverage_sentence
from ulna.ground.digits import figure_mm
from ulna.live.judging import HeldOut

WORDS = {"rms": "rms", "max": "largest", "max_abs": "largest", "largest": "largest"}
"""Figures of a quantity that are said."""
EXPECTED = "length_error"
"""The quantity of which it is known what was to be expected."""


def fresh_lines(found: HeldOut) -> list[str]:
    """ "10 fresh places, not fitted: 20 touches", then each quantity beside what was expected and what was before."""
    places = f"{found.places} fresh place{'' if found.places == 1 else 's'}"
    return [f"{places}, not fitted: {found.evaluation.readings} touches", *_figures(found), *_inside(found)]


def _figures(found: HeldOut) -> Iterator[str]:
    overall, before = found.evaluation.overall, found.before
    for quantity in QUANTITIES:
        names = {figure: quantity.figure(figure) for figure in quantity.figures if figure in WORDS}
        said = [f"{WORDS[figure]} {figure_mm(overall[name])} mm" for figure, name in names.items() if name in overall]
        if not said:
            continue
        yield f"  {quantity.label}: {', '.join(said)}"
        beside, first = [], next(iter(names.values()))
        if quantity.name == EXPECTED and found.expected_mm is not None:
            beside.append(f"expected from what is known: rms {figure_mm(found.expected_mm)} mm")
        if first in before:
            beside.append(f"before: {figure_mm(before[first])} mm")
        if beside:
            yield f"    {'; '.join(beside)}"


def _inside(found: HeldOut) -> Iterator[str]:
    coverage = found.evaluation.coverage
    if coverage is None:
        return
    for what, share in coverage.shares:
        yield f"  {share.inside} of {share.count} {what} inside their stated {100 * P:g} % intervals"
    doubt = coverage_sentence(coverage)
    if doubt:
        yield f"  {doubt}"
