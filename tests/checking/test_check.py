"""A check: its figures are those of an acceptance test, its history what was before, its advice of what is out."""

from __future__ import annotations

import json
import shutil
import warnings
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from tests.formats.test_schema import FOLDER, _known

import ulna
from ulna.checking.advice import ALONE, BOTH, NO_OTHER, SLOW, advice
from ulna.checking.result_file import load_check
from ulna.ground.errors import InputWarning, UlnaInputError
from ulna.verification.kinds.registry import KINDS

FOSSILS = Path(__file__).parents[1] / "data" / "fossils"
PLATINUM = Path(__file__).parents[2] / "examples" / "platinum"
PROTOCOL, READINGS = FOSSILS / "protocol-1.toml", FOSSILS / "protocol-1.csv"


def morning(day: int) -> Path:
    return PLATINUM / f"morning-11-{day:02d}.csv"


@pytest.fixture(scope="module")
def checks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Seven mornings of an arm that has not changed, each judged by those before."""
    folder = tmp_path_factory.mktemp("checks")
    for day in (2, 4, 6, 9, 11, 13, 16):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)
            found = ulna.check(PLATINUM / "protocol.toml", morning(day), [folder], date=f"2026-11-{day:02d}")
        found.save(folder / f"{day:02d}.json")
        assert not found.broken
    return folder


def test_protocol_1_has_the_figures_of_closed_forms() -> None:
    """The seat's touches about their mean; the bar at 21 °C is 500 · 11.5e-6 = 5.75 µm longer."""
    found = ulna.check(PROTOCOL, READINGS, date="2026-11-12", operator="K.")
    values = {each.called: 1000.0 * each.judged.single.value_mm for each in found.figures}
    points = np.array([[0.0, 0.0], [6.0, 0.0], [0.0, 8.0], [-6.0, -8.0]])
    assert values["SPAT_max, stick, near"] == pytest.approx(np.linalg.norm(points, axis=1).max(), abs=1e-6)
    assert values["SPAT_2S, stick, near"] == pytest.approx(2.0 * np.sqrt((points**2).sum() / 3.0), abs=1e-6)
    assert values["E_Uni, stick, left"] == pytest.approx(20.0 - 5.75, abs=1e-6)
    assert values["E_Uni, stick, right"] == pytest.approx(-5.75, abs=1e-6)
    (left,) = (each.judged for each in found.figures if each.called == "E_Uni, stick, left")
    u = np.sqrt(1.0 + (500e3 * 11.5e-6 * 0.2) ** 2 + (500e3 * 1.0 * 1e-6) ** 2 + 1.0)
    assert 1000.0 * (left.single.budget.u_mm or 0.0) == pytest.approx(u, abs=1e-9)
    assert left.limit_mm == pytest.approx(0.03 + 500.00575 / 50000)
    assert left.decided.verdict == "pass"
    assert found.departures == [
        "seat: touches of a seat: 4 of artefact stick, position near; the profile counts 5 of each."
    ]
    assert (found.in_control, found.broken, found.operator) == (None, False, "K.")


def test_check_1_loads_fits_its_schema_and_is_a_history() -> None:
    path = FOSSILS / "check-1.json"
    document = json.loads(path.read_text(encoding="utf-8"))
    schema = json.loads((FOLDER / "ulna-check-1.json").read_text(encoding="utf-8"))
    assert _known(schema, schema, document, "") == []
    loaded, time, _ = load_check(path)
    assert loaded.model_dump() == document, "one model reads and writes: nothing is lost, nothing is added"
    assert time == datetime(2026, 11, 9, 7, 45, tzinfo=UTC)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = ulna.check(PROTOCOL, READINGS, path, date="2026-11-12")
    (left,) = (each.history for each in found.figures if each.called == "E_Uni, stick, left")
    (right,) = (each.history for each in found.figures if each.called == "E_Uni, stick, right")
    assert left is not None
    assert right is not None
    assert (left.earlier, left.not_used) == (0, 1), "there it was out by itself"
    assert (right.earlier, right.not_used, right.basis.too_few) == (1, 0, True)
    fresh = found.as_dict()
    assert list(fresh) == list(document)
    assert [list(each) for each in fresh["figures"]] == [list(each) for each in document["figures"]]


def test_checks_1_are_the_history_that_check_1_was_judged_by() -> None:
    """Five mornings; what they say of a baseline must come out forever."""
    found = ulna.check(PROTOCOL, READINGS, FOSSILS / "checks-1", date="2026-11-12")
    right = found.figures[-1]
    assert right.history is not None
    assert (right.called, right.history.basis.n, right.history.basis.span_days) == ("E_Uni, stick, right", 5, 4.0)
    values = np.array([1.0, 2.0, 3.0, 4.0, 5.0]) - 5.75
    half = stats.t.isf(0.005, 4) * values.std(ddof=1) * np.sqrt(1.2)
    assert 1000.0 * right.history.centre == pytest.approx(values.mean(), abs=1e-6)
    assert 1000.0 * right.history.upper == pytest.approx(values.mean() + half, abs=1e-6)
    assert 1000.0 * right.history.lower == pytest.approx(values.mean() - half, abs=1e-6)
    assert right.history.average == pytest.approx(0.7 * right.history.centre - 0.3 * 0.00575)
    assert right.history.in_control


def test_it_is_the_acceptance_test_of_the_same_touches(tmp_path: Path) -> None:
    """By a profile and a verify file that say the same, in their own words."""
    shutil.copy(READINGS, tmp_path / "t.csv")
    text = PROTOCOL.read_text().replace("item =", "arm =").replace("protocol-1.csv", "t.csv")
    tests = text[text.index("[test.seat]") : text.index("[limit]")]
    profile = 'format = "ulna-profile/1"\nname = "p"\nstandard = "s"\nstatement = "s"\n'
    decision = next(line for line in text.splitlines() if line.startswith("decision"))
    (tmp_path / "p.toml").write_text(f"{profile}{decision}\n{tests}")
    rest = text[text.index("[limit]") : text.index("[readings]")].replace("[limit]", "[mpe]")
    (tmp_path / "v.toml").write_text(
        'format = "ulna-verify/1"\nprofile = "p.toml"\nball = 6.0\nunits = { length = "mm", angle = "deg" }\n'
        f'{rest}\n[[readings]]\nfile = "t.csv"\nartefact = "stick"\n'
    )
    verified = ulna.verify(tmp_path / "v.toml").states[0].figures.values()
    judged = [each for figure in verified for each in figure.values]
    assert [each.judged for each in ulna.check(PROTOCOL, READINGS).figures] == judged


def test_a_knock_is_seen_and_a_steady_morning_is_not(checks: Path) -> None:
    found = ulna.check(PLATINUM / "protocol.toml", morning(18), [checks], date="2026-11-18")
    assert (found.broken, found.in_control, found.verdict) == (True, False, "fail")
    assert len(found.history) == 7
    assert {each.test for each in found.advice} == {"seat", "bar"}
    assert all(each.steps[3] == BOTH for each in found.advice)
    assert "SPAT_max" in found.advice[0].figures
    history = found.figures[0].history
    assert history is not None
    assert (history.basis.n, history.basis.span_days) == (7, 14.0)


def test_what_cannot_be_its_history_is_told_and_not_used(checks: Path, tmp_path: Path) -> None:
    folder = tmp_path / "checks"
    shutil.copytree(checks, folder)
    (folder / "result.json").write_text('{"format": "ulna-result/1"}')
    with pytest.warns(InputWarning) as told:
        found = ulna.check(PLATINUM / "protocol.toml", morning(9), [folder], date="2026-11-12")
    said = " ".join(str(each.message) for each in told)
    assert "history: 1 check is of the same readings as another one: not used." in said
    assert "history: 2 checks are not earlier than this one: not used." in said
    assert len(found.history) == 4
    recalibrated = tmp_path / "after"
    recalibrated.mkdir()
    shutil.copy(PLATINUM / "protocol.toml", recalibrated)
    arm = (PLATINUM / "truth.toml").read_text()
    (recalibrated / "truth.toml").write_text(arm.replace("0.879434", "0.879435"))
    with pytest.warns(InputWarning, match="7 checks are of the arm before it was calibrated as it is now: not used"):
        anew = ulna.check(recalibrated / "protocol.toml", morning(18), [checks], date="2026-11-18")
    assert anew.history == []
    with pytest.warns(InputWarning, match="there is no check in it"):
        ulna.check(PROTOCOL, READINGS, recalibrated)


def test_a_history_of_something_else_is_refused(checks: Path, tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match=r"02\.json: it is a check of the protocol 'before work', this one is of"):
        ulna.check(PROTOCOL, READINGS, [checks])
    other = tmp_path / "p.toml"
    other.write_text(PROTOCOL.read_text().replace('"arm 7"', '"arm 8"'))
    with pytest.raises(UlnaInputError, match=r"it is a check of the arm 'arm 7', this one is of 'arm 8'"):
        ulna.check(other, READINGS, FOSSILS / "check-1.json")
    with pytest.raises(UlnaInputError, match=r"date: got 'monday', expected a date"):
        ulna.check(PROTOCOL, READINGS, date="monday")
    document = json.loads((FOSSILS / "check-1.json").read_text())
    document["figures"][1]["value"] = 1e300
    (tmp_path / "far.json").write_text(json.dumps(document))
    with pytest.raises(
        UlnaInputError, match=r"far\.json: key 'figures\.2\.value': got 1e\+300, more than any length is"
    ):
        ulna.check(PROTOCOL, READINGS, tmp_path / "far.json")
    broken = json.loads((FOSSILS / "check-1.json").read_text()) | {"time": "2026-13-01"}
    (tmp_path / "c.json").write_text(json.dumps(broken))
    with pytest.raises(UlnaInputError, match=r"c\.json: key 'time': got '2026-13-01'"):
        ulna.check(PROTOCOL, READINGS, tmp_path / "c.json")


def test_it_does_not_overwrite_what_it_was_made_from(checks: Path) -> None:
    found = ulna.check(PLATINUM / "protocol.toml", morning(18), [checks], date="2026-11-18")
    for path in (checks / "02.json", morning(18), PLATINUM / "protocol.toml", PLATINUM / "truth.toml"):
        with pytest.raises(UlnaInputError, match="is an input of this run"):
            found.save(path, force=True)
    with pytest.raises(UlnaInputError, match="exists already"):
        ulna.check(PLATINUM / "protocol.toml", morning(18)).save(checks / "02.json")


def test_of_every_kind_of_test_it_is_said_what_to_try() -> None:
    for kind, own in KINDS.items():
        for slow in (False, True):
            steps = advice(kind, slow, {})
            assert steps[0] == (SLOW if slow else own.again)
            assert steps[1] == own.look
            assert steps[3] == NO_OTHER
            assert "ulna calibrate" in steps[4]
    assert advice("single-point", False, {"length": True})[3] == BOTH
    assert advice("single-point", False, {"length": False})[3] == ALONE[False]
    assert advice("length", False, {"single-point": False, "volumetric": True})[3] == ALONE[True]
