"""Which file knows which kind of test, and which figures it gives."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ulna.verification.bench import Bench, Found
from ulna.verification.figures.asme_b89_4_22 import (
    DIAMETER,
    DIAMETER_SPREAD,
    DIAMETER_WORST,
    SPAT_2S,
    SPAT_MAX,
    VOLUMETRIC_2RMS,
    VOLUMETRIC_2S,
    VOLUMETRIC_HALF_RANGE,
    VOLUMETRIC_MAX,
)
from ulna.verification.figures.faro import SPAT_AXES
from ulna.verification.figures.figure import Definition
from ulna.verification.figures.iso_10360_12 import E_BI, E_UNI, L_DIA, P_FORM, P_SIZE
from ulna.verification.kinds.articulation import articulation
from ulna.verification.kinds.effective_diameter import effective_diameter
from ulna.verification.kinds.length import length
from ulna.verification.kinds.single_point import single_point
from ulna.verification.kinds.sphere import sphere
from ulna.verification.kinds.volumetric import volumetric
from ulna.verification.profile_tables import TestTable
from ulna.verification.touches import Touches

_EVALUATE: dict[str, Callable[[str, Any, Touches, Bench], Found]] = {
    "sphere": sphere,
    "articulation": articulation,
    "length": length,
    "effective-diameter": effective_diameter,
    "single-point": single_point,
    "volumetric": volumetric,
}


def evaluate(name: str, table: TestTable, touches: Touches, bench: Bench) -> Found:
    """One test. Raises UlnaInputError."""
    return _EVALUATE[table.kind](name, table, touches, bench)


def figures_of(table: TestTable) -> list[Definition]:
    """What a test gives."""
    if table.kind == "sphere":
        return [P_SIZE, P_FORM]
    if table.kind == "articulation":
        return [L_DIA]
    if table.kind == "length":
        return [E_BI if table.direction == "bi" else E_UNI]
    if table.kind == "effective-diameter":
        return [DIAMETER, DIAMETER_WORST, DIAMETER_SPREAD]
    if table.kind == "single-point":
        asme = [SPAT_MAX, SPAT_2S] if "asme" in table.figures else []
        return [*asme, *(SPAT_AXES if "faro" in table.figures else ())]
    return [VOLUMETRIC_MAX, VOLUMETRIC_2S, VOLUMETRIC_HALF_RANGE, VOLUMETRIC_2RMS]
