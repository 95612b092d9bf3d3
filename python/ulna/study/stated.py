"""Artefacts as a program states them: objects, or tables with the keys of a study file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import ArtefactTable, check_kinds, made
from ulna.artefacts.tables import Place
from ulna.formats.models import Strict, fill
from ulna.formats.units import MM_PER
from ulna.ground.errors import UlnaInputError, wrong_type

EXPECTED = (
    "artefacts: a dict of name = table (such as {'bar': {'kind': 'bar', 'length_mm': 443.172}}) or Artefact, one table "
    "alone, or Artefacts"
)
NO_LENGTHS = ("scale", "u_scale")
"""Keys of numbers that are no lengths."""


class _Tables(Strict):
    artefact: Annotated[dict[str, ArtefactTable], Field(min_length=1)]


def artefacts_of(given: Any, length_unit: str | None, place: Place) -> dict[str, Artefact]:
    """By name. Keys of tables may end in the unit, `length_mm`; others are in `length_unit`.

    Raises UlnaInputError for tables that cannot be used, TypeError for what is none.
    """
    if isinstance(given, Artefact):
        return {given.name: given}
    if isinstance(given, Sequence) and not isinstance(given, str | bytes):
        if not given or not all(isinstance(each, Artefact) for each in given):
            raise wrong_type(given, EXPECTED)
        return {each.name: each for each in given}
    if not isinstance(given, Mapping) or not given:
        raise wrong_type(given, EXPECTED)
    if isinstance(given.get("kind"), str):
        given = {given["kind"]: given}
    tables: dict[str, Any] = {}
    found: dict[str, Artefact] = {}
    for name, each in given.items():
        if isinstance(each, Mapping):
            tables[str(name)] = _table(str(name), each, length_unit, place)
        elif not isinstance(each, Artefact):
            raise wrong_type(each, EXPECTED)
    if tables:
        check_kinds({"artefact": tables}, place.path)
    filled = fill(_Tables, {"artefact": tables}, place.path).artefact if tables else {}
    for name, each in given.items():
        found[str(name)] = made(str(name), filled[str(name)], place) if str(name) in filled else each
    return found


def _table(name: str, table: Mapping[Any, Any], length_unit: str | None, place: Place) -> dict[str, Any]:
    """With the keys of a study file, in the unit of the place. Raises UlnaInputError for a length without a unit."""
    found: dict[str, Any] = {}
    for key, value in table.items():
        plain = _plain(value)
        if str(key).endswith("_mm"):
            found[str(key).removesuffix("_mm")] = _times(plain, 1.0 / place.units.mm)
            continue
        if length_unit is None and key not in NO_LENGTHS and _is_length(plain):
            raise UlnaInputError(
                f"{place.path}: key 'artefact.{name}.{key}': its unit is not stated, and never guessed; expected "
                f"{key}_mm, or length_unit = {' or '.join(map(repr, MM_PER))}. State it."
            )
        found[str(key)] = plain
    return found


def _is_length(value: Any) -> bool:
    """Numbers, alone or in a table; names and yes or no are none."""
    return isinstance(value, int | float | list | dict) and not isinstance(value, bool)


def _times(value: Any, factor: float) -> Any:
    if factor == 1.0:
        return value
    if isinstance(value, dict):
        return {key: _times(each, factor) for key, each in value.items()}
    if isinstance(value, list):
        return [_times(each, factor) for each in value]
    return value * factor if isinstance(value, int | float) and not isinstance(value, bool) else value


def _plain(value: Any) -> Any:
    """Arrays and numbers of NumPy as files have them."""
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items()}
    return [_plain(each) for each in value] if isinstance(value, list | tuple) else value
