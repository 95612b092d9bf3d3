"""What every kind of artefact owes, whatever it is: one row of `ulna.artefacts.kinds`, one example here."""

from __future__ import annotations

import re
import tomllib
from abc import ABC
from collections.abc import Iterator
from dataclasses import fields
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.simulations import NOISE, write

import ulna
from ulna import Study
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kind import Kind
from ulna.artefacts.kinds import KINDS, kind_of
from ulna.artefacts.quantities import QUANTITIES
from ulna.calibration.figures import figures
from ulna.ground.owed import missing
from ulna.study.assembly import assemble

#: one of each, as a simulation file states it
EXAMPLES: dict[str, str] = {
    "bar": "length = 443.172\nu = 0.001\nplacements = 40",
    "seat": "placements = 2",
    "points": "features = { a = [0, 0, 0], b = [300, 0, 0], c = [0, 200, 0], d = [300, 200, 40] }\nu = 0.001",
    "length": "length = 300.0\nu = 0.001\nplacements = 40",
    "sphere": "diameter = 25.0\nu = 0.002",
    "plane": "size = [150, 150]",
    "distance": "offset = 12.5\nu_offset = 0.001\nscale = 1.001\nu_scale = 1e-6",
    "cylinder": "diameter = 60.0\nu = 0.002",
    "orientation": 'rotation = "vector"\nu = 2e-5',
}

#: what may be left to the general answer
OWED = {
    "name": "the word for it in files",
    "table": "its table in a study file",
    "simulated": "its table in a simulation file",
    "named": "whether a row names a feature",
    "scattered": "whether touches are spread over it",
    "residual_columns": "the columns of its residuals",
    "dimensions": "what a certificate states of it",
    "enter": "how its readings enter the core",
    "errors": "what a metrologist reads",
    "drawn": "how the artefact itself differs from its certificate",
    "touched": "where it is touched",
}

each_kind = pytest.mark.parametrize("kind", KINDS.values(), ids=str)


def spec(folder: Path, kind: Kind, more: str = NOISE) -> Path:
    assert kind.name in EXAMPLES, f"kind '{kind.name}' has no example here: add one to EXAMPLES"
    return write(folder, f'[artefact.thing]\nkind = "{kind.name}"\n{EXAMPLES[kind.name]}\n', more)


@each_kind
def test_nothing_is_missing(kind: Kind) -> None:
    assert missing("kind", type(kind), OWED) == []
    assert type(kind).__doc__
    assert kind.name == next(iter(kind.table.model_fields["kind"].annotation.__args__))  # type: ignore[union-attr]
    assert issubclass(kind.simulated, kind.table)


def test_what_is_missing_is_said_in_words() -> None:
    class Cone(Kind, ABC):
        name = "cone"
        named = False

    lacks = missing("kind", Cone, OWED)
    assert "kind 'cone' lacks touched: where it is touched" in lacks
    assert "kind 'cone' lacks table: its table in a study file" in lacks
    assert not any("lacks named" in each for each in lacks)


def test_a_kind_that_there_is_not_is_an_error() -> None:
    with pytest.raises(ulna.UlnaInputError, match="there is no kind 'cylindre'"):
        kind_of(Artefact("thing", "cylindre", {}))


@each_kind
def test_every_language_has_words_for_it(kind: Kind) -> None:
    folder = resources.files("ulna.documents.languages")
    for file in (each for each in folder.iterdir() if each.name.endswith(".toml")):
        words = tomllib.loads(file.read_text(encoding="utf-8"))
        assert f"kind.{kind.name}" in _keys(words), f"{file.name} lacks kind.{kind.name}"


def _keys(words: dict[str, Any], before: str = "") -> Iterator[str]:
    for key, value in words.items():
        if isinstance(value, dict):
            yield from _keys(value, f"{before}{key}.")
        else:
            yield before + key


@each_kind
def test_files_come_back_as_they_were(kind: Kind, tmp_path: Path) -> None:
    simulated = ulna.simulate(spec(tmp_path, kind))
    simulated.save(tmp_path / "out")
    back = Study.load(tmp_path / "out" / "study.toml")
    (ours,), (read,) = simulated.study.readings, back.readings
    for name in (field.name for field in fields(Artefact)):
        assert getattr(read.artefact, name) == getattr(ours.artefact, name), name
    for name in ("q_rad", "p_rad", "length_mm", "probe", "feature", "placement"):
        mine, theirs = getattr(ours, name), getattr(read, name)
        assert (mine is None) == (theirs is None), name
        assert mine is None or np.array_equal(mine, theirs), name


@each_kind
def test_what_is_taken_as_certain_has_no_uncertainty(kind: Kind, tmp_path: Path) -> None:
    """It is the same artefact, of which nothing is uncertain or fitted."""
    stated = ulna.simulate(spec(tmp_path, kind)).study.readings[0].artefact
    certain = kind.certain(stated)
    before, after = kind.dimensions(stated), kind.dimensions(certain)
    assert [(each.name, each.value) for each in after] == [(each.name, each.value) for each in before]
    assert all(each.u == 0.0 and not each.fitted for each in after)
    assert certain.u_mm == 0.0
    assert certain.feature_u_mm is None
    assert certain.features == stated.features


@each_kind
def test_exact_readings_have_no_errors(kind: Kind, tmp_path: Path) -> None:
    """Readings without noise of the true artefact, judged with the true arm: every figure is zero."""
    without_u = spec(tmp_path, kind, 'drawing = "exact"')
    without_u.write_text(re.sub(r"^u(_\w+)? = .*$", "", without_u.read_text(), flags=re.MULTILINE))
    simulated = ulna.simulate(without_u)
    entries, overall = figures(simulated.truth.arm, simulated.study)
    assert overall, "a kind gives at least one figure"
    assert all(abs(value) < 1e-8 for value in overall.values()), overall
    known = {name for quantity in QUANTITIES for name in quantity.names()}
    assert set(overall) <= known
    assert {entry.kind for entry in entries} == {kind.name}


@each_kind
def test_exact_readings_have_no_residuals(kind: Kind, tmp_path: Path) -> None:
    simulated = ulna.simulate(spec(tmp_path, kind, 'drawing = "exact"\nfit = { hold = ["*"] }'))
    stated = simulated.study.readings[0].artefact
    true = simulated.truth.touchings[0].artefact
    result = ulna.evaluate(simulated.truth.arm, simulated.study)
    off = [abs(a.value - b.value) for a, b in zip(kind.dimensions(stated), kind.dimensions(true), strict=True)]
    assert result.rms_mm < 1e-6 + 2.0 * sum(off) + 3.0 * stated.u_mm


@each_kind
def test_noise_is_seen_as_it_is(kind: Kind, tmp_path: Path) -> None:
    """Judged by the true arm, residuals are what the stated noise makes of them: chi² per degree of freedom near 1."""
    more = f'{NOISE}\ndrawing = "exact"\nfit = {{ hold = ["joint.*", "probe.*"] }}'
    simulated = ulna.simulate(spec(tmp_path, kind, more))
    result = ulna.calibrate(simulated.study)
    freedom = result.fit.degrees_of_freedom
    assert freedom >= 10
    assert abs(result.fit.chi2_per_dof - 1.0) < 5.0 * np.sqrt(2.0 / freedom)


@each_kind
def test_rows_have_the_columns_that_are_owed(kind: Kind, tmp_path: Path) -> None:
    result = ulna.evaluate(*(lambda s: (s.truth.arm, s.study))(ulna.simulate(spec(tmp_path, kind))))
    table = result.residuals
    there = {name for name in table.columns if not table[name].is_null().all()}
    own = {name for each in KINDS.values() for name in each.residual_columns}
    assert there & own == set(kind.residual_columns)


@each_kind
def test_the_core_knows_as_much_as_the_tips(kind: Kind, tmp_path: Path) -> None:
    """Readings enter the core whole: every row counts, and none twice."""
    study = ulna.simulate(spec(tmp_path, kind)).study
    group = study.readings[0]
    fitted = ulna.evaluate(study.arm, study)
    assert fitted.residuals.height == len(group)
    assert assemble(study).problem.parameter_names[: len(study.arm.parameter_names)] == study.arm.parameter_names
