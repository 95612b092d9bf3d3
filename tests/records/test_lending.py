"""A study that names an artefact of the record has its certified length and u, or is refused in words."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest
from tests.small_study import SmallStudy

from ulna import InputWarning, Study, UlnaInputError
from ulna.records.place import WHERE
from ulna.records.records import Records


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Records:
    monkeypatch.setenv(WHERE, str(tmp_path / "bench"))
    records = Records.init(tmp_path / "bench", by="Jan")
    records.register("KB-443", "artefact", serial="S-1")
    return records


@pytest.fixture
def small(tmp_path: Path) -> SmallStudy:
    folder = tmp_path / "study"
    folder.mkdir()
    study = SmallStudy(folder)
    study.swap("study.toml", 'kind = "bar"\nlength = 443.172\nu = 0.001\n', 'record = "KB-443"\n')
    return study


def loaded(study: SmallStudy) -> tuple[Study, str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        found = Study.load(study.path)
    return found, " ".join(str(each.message) for each in caught)


def test_length_and_u_are_those_of_the_certificate(bench: Records, small: SmallStudy) -> None:
    bench.certify("KB-443", {"length": (443.1719, 0.0007)}, number="EX-1", valid_to="2099-01-01")
    study, said = loaded(small)
    artefact = study.readings[0].artefact
    assert (artefact.kind, artefact.length_mm, artefact.u_mm) == ("bar", 443.1719, 0.0007)
    assert artefact.record == "KB-443"
    assert "certificate EX-1" in said
    assert study.warnings


@pytest.mark.parametrize(("unit", "mm"), [("m", 1000.0), ("in", 25.4)])
def test_in_the_units_of_the_study(bench: Records, small: SmallStudy, unit: str, mm: float) -> None:
    bench.certify("KB-443", {"length": (443.1719, 0.0007)})
    small.swap("study.toml", 'length = "mm"', f'length = "{unit}"')
    small.swap("study.toml", "seat = 0.005", f"seat = {0.005 / mm}")
    artefact = loaded(small)[0].readings[0].artefact
    assert artefact.length_mm == pytest.approx(443.1719, rel=1e-15)
    assert artefact.u_mm == pytest.approx(0.0007, rel=1e-15)


def test_a_later_certificate_takes_the_place_of_an_earlier_one(bench: Records, small: SmallStudy) -> None:
    bench.certify("KB-443", {"length": (443.3, 0.002)}, valid_from="2025-01-01", valid_to="2099-01-01")
    bench.certify("KB-443", {"length": (443.1, 0.001)}, valid_from="2020-01-01", valid_to="2098-01-01")  # entered late
    assert loaded(small)[0].readings[0].artefact.length_mm == 443.3


def test_an_expired_certificate_needs_a_reason_which_is_kept(bench: Records, small: SmallStudy) -> None:
    bench.certify("KB-443", {"length": (443.1719, 0.0007)}, number="EX-1", valid_to="2025-01-01")
    with pytest.raises(UlnaInputError, match="was valid to 2025-01-01"):
        loaded(small)
    small.swap("study.toml", 'record = "KB-443"', 'record = "KB-443"\nexpired_because = "the new one is on its way"')
    study, said = loaded(small)
    assert "NOT VALID" in said
    assert "the new one is on its way" in " ".join(study.warnings)


def test_what_cannot_be_lent_is_said(bench: Records, small: SmallStudy, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(UlnaInputError, match="has no certified length or diameter"):
        loaded(small)
    bench.certify("KB-443", {"length": (443.1719, 0.0007)})
    bench.event("KB-443", "quarantine", "dropped")
    with pytest.raises(UlnaInputError, match="is quarantined"):
        loaded(small)
    small.swap("study.toml", 'record = "KB-443"', 'record = "KB-444"')
    with pytest.raises(UlnaInputError, match=r"artefact\.bar\.record'.*Did you mean 'KB-443'"):
        loaded(small)
    monkeypatch.delenv(WHERE)
    monkeypatch.setenv("XDG_CONFIG_HOME", "/nowhere")
    with pytest.raises(UlnaInputError, match="no record is named"):
        loaded(small)


def test_a_length_beside_the_record_is_refused(bench: Records, small: SmallStudy) -> None:
    bench.certify("KB-443", {"length": (443.1719, 0.0007)})
    small.swap("study.toml", 'record = "KB-443"', 'record = "KB-443"\nlength = 400.0')
    with pytest.raises(UlnaInputError, match=r"unknown key 'artefact\.bar\.length'"):
        loaded(small)


def test_a_diameter_is_that_of_a_sphere_or_of_what_is_said(bench: Records) -> None:
    from ulna.artefacts.lent import LentTable, stated
    from ulna.artefacts.tables import Place
    from ulna.formats.units import Units

    bench.certify("KB-443", {"diameter": (25.0003, 0.0002)})
    place = Place(Path("study.toml"), Units(length="mm", angle="rad"), [])
    assert stated("ball", LentTable(record="KB-443"), place).kind == "sphere"
    assert stated("bore", LentTable(record="KB-443", kind="cylinder"), place).kind == "cylinder"
    with pytest.raises(UlnaInputError, match="has no certified length"):
        stated("bar", LentTable(record="KB-443", kind="bar"), place)
