"""A laboratory's calibration and measurement capability (CMC), and test values that may not be stated below it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ulna.documents.laboratory.tables import CapabilityTable, LaboratoryFile
from ulna.formats.units import MM_PER
from ulna.ground.errors import nearest
from ulna.verification.decision import Limit
from ulna.verification.kinds.registry import KINDS
from ulna.verification.lifted import Lifted, lifted
from ulna.verification.limits import LimitTable
from ulna.verification.result_file import VerificationFile


@dataclass(frozen=True)
class Stated:
    """A verification as a laboratory may state it."""

    file: VerificationFile
    lifted: list[Lifted] = field(default_factory=list)
    """Figures with a U that was below the CMC."""
    without: list[str] = field(default_factory=list)
    """Short names of figures with a U of which an accredited laboratory states no CMC."""
    accredited: bool = False


def stated_by(file: VerificationFile, laboratory: LaboratoryFile | None) -> Stated:
    """With every U below the CMC lifted to it; without a laboratory as it is."""
    if laboratory is None:
        return Stated(file)
    capability, accredited = least_expanded(laboratory.cmc), laboratory.laboratory.accreditation is not None
    made, told = lifted(file, capability)
    figures = [figure for state in file.states for test in state.tests for figure in test.figures]
    with_u = list(dict.fromkeys(figure.key for figure in figures if figure.u is not None))
    return Stated(made, told, [key for key in with_u if accredited and key not in capability], accredited)


def least_expanded(table: CapabilityTable | None) -> dict[str, Limit]:
    """The smallest U by the short name of a figure, mm."""
    if table is None:
        return {}
    mm = MM_PER[table.unit]
    return {
        key: Limit(each.a * mm, each.b) if isinstance(each, LimitTable) else Limit(each * mm)
        for key, each in table.figure.items()
    }


def unknown_figures(table: CapabilityTable) -> Iterator[str]:
    """Names that no test gives, in words."""
    known = {figure.key for kind in KINDS.values() for each in kind.examples() for figure in kind.figures(each)}
    for key in table.figure:
        if key not in known:
            yield (
                f"key 'cmc.figure.{key}': no test gives a figure of this name.{nearest(key, sorted(known))} Correct it."
            )
