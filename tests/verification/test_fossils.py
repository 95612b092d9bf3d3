"""One sample of each format of acceptance tests, never changed again: what they say must arrive forever."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from tests.formats.test_schema import FOLDER, _known

import ulna
from ulna.verification.conformity import Made
from ulna.verification.result_file import load_verification

FOSSILS = Path(__file__).parents[1] / "data" / "fossils"


def test_verify_1_with_profile_1() -> None:
    """P_Form 30 µm; L_Dia √(30² + 40²) = 50 µm; the bar at 22 °C is 500·11.5e-6·2 = 11.5 µm longer: 8.5 and -21.5;
    diameters +10 and +30 µm less 25·5.5e-6·2 = 0.275 µm; SPAT 4 µm, 2·√(50/3) µm; bars -1.5 and -41.5 µm."""
    found = ulna.verify(FOSSILS / "verify-1.toml")
    values = {figure.definition.key: 1000 * figure.worst.single.value_mm for figure in found.states[0].figures.values()}
    assert values == pytest.approx(
        {
            "P_Size": 20.0 - 0.275,
            "P_Form": 30.0,
            "L_Dia": 50.0,
            "E_Uni": -21.5,
            "Diameter_mean": 20.0 - 0.275,
            "Diameter_max": 30.0 - 0.275,
            "Diameter_s": 200**0.5,
            "SPAT_max": 4.0,
            "SPAT_2S": 2 * (50 / 3) ** 0.5,
            "FARO_SPAT_x": 3.0,
            "FARO_SPAT_y": 4.0,
            "FARO_SPAT_z": 0.0,
            "Volumetric_max": -41.5,
            "Volumetric_2S": 2 * 800**0.5,
            "Volumetric_half_range": 20.0,
            "Volumetric_2RMS": 2 * ((1.5**2 + 41.5**2) / 2) ** 0.5,
        },
        abs=1e-6,
    )
    assert found.plan.profile.file.test.keys() == {"probing", "articulation", "uni", "diameter", "spat", "bars"}
    limits = {figure.definition.key: figure.worst.limit_mm for figure in found.states[0].figures.values()}
    assert limits["P_Form"] == pytest.approx(0.002 * 25.4)
    assert limits["E_Uni"] == pytest.approx(0.03 + 500.0115 / 60000)
    assert limits["SPAT_2S"] == pytest.approx(0.0254)
    assert (found.rule.rule, found.rule.k, found.rule.p) == ("1.65u", 2.5, 0.98)
    assert [state.state for state in found.states] == ["as-found"]


#: keys that came after the fossil without them
LATER = {"scanner", "r", "conformity", "risk"}
FOSSIL = [("verify-1.toml", "verification-1.json", LATER), ("verify-1-risk.toml", "verification-1-risk.json", set())]


def older(value: Any, later: set[str]) -> Any:
    """A document as it was before those keys."""
    if isinstance(value, dict):
        return {key: older(inner, later) for key, inner in value.items() if key not in later}
    return [older(inner, later) for inner in value] if isinstance(value, list) else value


def test_verify_1_with_what_decisions_risk() -> None:
    found = ulna.verify(FOSSILS / "verify-1-risk.toml")
    assert (found.rule.rule, found.rule.r, found.plan.file.scanner) == ("rU", 0.7, "laser line scanner")
    figures = found.states[0].figures
    size, form = figures["P_Size.Sph.1x25:Tact.AArm"].risk, figures["P_Form.Sph.1x25:Tact.AArm"].risk
    assert size is not None
    assert size.process == Made(0.001, 0.01, "normal")
    assert form is not None
    assert form.process == Made(0.02, 0.008, "gamma")


@pytest.mark.parametrize(("plan", "fossil", "later"), FOSSIL)
def test_verification_1(plan: str, fossil: str, later: set[str]) -> None:
    loaded, _ = load_verification(FOSSILS / fossil)
    assert loaded.arm == "a fossil of every key"
    assert loaded.states[0].tests[0].figures[0].budget[0].name == "calibration"
    document = json.loads((FOSSILS / fossil).read_text(encoding="utf-8"))
    schema = json.loads((FOLDER / "ulna-verification-1.json").read_text(encoding="utf-8"))
    assert _known(schema, schema, document, "") == []
    assert loaded.provenance.files[0].rows == 42
    assert loaded.environment.temperature is not None
    again = loaded.model_dump(exclude_unset=True)
    assert again == document, "one model reads and writes: nothing is lost, nothing is added"
    fresh = older(ulna.verify(FOSSILS / plan).as_dict(), later)
    assert fresh.keys() == document.keys()
    for new, old in zip(fresh["states"][0]["tests"], document["states"][0]["tests"], strict=True):
        for ours, theirs in zip(new["figures"], old["figures"], strict=True):
            assert ours.keys() == theirs.keys()
            assert ours["value"] == pytest.approx(theirs["value"], abs=1e-10)
            assert (ours["verdict"], ours["formula"]) == (theirs["verdict"], theirs["formula"])


@pytest.mark.parametrize(("plan", "fossil", "later"), FOSSIL)
def test_verification_1_is_written_in_its_order(plan: str, fossil: str, later: set[str]) -> None:
    """Keys stand as in the fossil, which a reader of the text may count on."""

    def order(value: object) -> object:
        if isinstance(value, dict):
            return [(key, order(inner)) for key, inner in value.items()]
        return [order(inner) for inner in value] if isinstance(value, list) else None

    document = json.loads((FOSSILS / fossil).read_text(encoding="utf-8"))
    assert order(older(ulna.verify(FOSSILS / plan).as_dict(), later)) == order(document)
