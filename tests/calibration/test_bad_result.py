"""A result.json that was changed or damaged is no arm: quiet nonsense in its uncertainties would be worse than none."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.small_study import ARM, says

import ulna
from ulna import Arm, UlnaInputError
from ulna.arm.file import arm_document
from ulna.uncertainties.assess import check_known

NAMES = ["joint.1.a", "joint.2.d", "probe.bent.x"]
ROOT = np.random.default_rng(1).normal(0, 1e-3, (3, 2))  # of rank 2: on the edge of what is allowed
LOST = {"combination": {"joint.2.d": 1.0}, "because": "why.", "remedy": "what."}


def document(folder: Path) -> dict[str, Any]:
    (folder / "arm.toml").write_text(ARM)
    return {
        "format": "ulna-result/1",
        "arm": arm_document(Arm.load(folder / "arm.toml")),
        "covariance": {"names": list(NAMES), "matrix": (ROOT @ ROOT.T).tolist()},
        "identifiability": {"lost": [dict(LOST)]},
        "provenance": {"noise": {"encoder_rad": [1e-5, 1e-5, 1e-5]}},
    }


def put(*keys: Any) -> Callable[[dict[str, Any]], None]:
    """The value at a path of keys becomes the last argument."""

    def change(whole: Any) -> None:
        for key in keys[:-2]:
            whole = whole[key]
        whole[keys[-2]] = keys[-1]

    return change


def drop(*keys: Any) -> Callable[[dict[str, Any]], None]:
    def change(whole: Any) -> None:
        for key in keys[:-1]:
            whole = whole[key]
        del whole[keys[-1]]

    return change


def parameters(folder: Path, whole: dict[str, Any]) -> list[dict[str, Any]]:
    """As the arm and the names of the covariance have them."""
    arm, free = Arm.load(folder / "arm.toml"), whole["covariance"]["names"]
    rows = zip(arm.parameter_names, arm.parameter_units, arm.parameters.tolist(), strict=True)
    return [
        {"name": name, "unit": unit, "value": value, "u": None, "status": "fitted" if name in free else "held"}
        for name, unit, value in rows
    ]


def measured(folder: Path, whole: dict[str, Any]) -> Any:
    path = folder / "result.json"
    path.write_text(json.dumps({"parameters": parameters(folder, whole)} | whole))
    (folder / "q.csv").write_text("q1,q2,q3\n0.1,0.2,0.3\n")
    return ulna.measure(path, folder / "q.csv", "bent").table


CASES: dict[str, tuple[Callable[[dict[str, Any]], None], tuple[str, ...]]] = {
    "negative variance": (
        put("covariance", "matrix", 1, 1, -1e-6),
        ("'covariance.matrix'", "variance of joint.2.d is -1e-06"),
    ),
    "not symmetric": (put("covariance", "matrix", 0, 1, 1e-3), ("not symmetric", "joint.1.a, joint.2.d")),
    "not positive": (
        put("covariance", "matrix", [[1.0, 0.9, -0.9], [0.9, 1.0, 0.9], [-0.9, 0.9, 1.0]]),
        ("some combination of parameters has a negative variance",),
    ),
    "not a number": (put("covariance", "matrix", 0, 0, float("nan")), ("NaN is no number",)),
    "half empty": (put("covariance", "matrix", 0, 0, None), ("'covariance.matrix'", "got None for joint.1.a")),
    "huge": (put("covariance", "matrix", 0, 0, 10**400), ("'covariance.matrix'", "finite number")),
    "text": (put("covariance", "matrix", 0, 0, "1"), ("'covariance.matrix'", "got 1 for joint.1.a, joint.1.a")),
    "not square": (drop("covariance", "matrix", 0), ("'covariance.matrix'", "a square matrix of 3 rows")),
    "no matrix": (drop("covariance", "matrix"), ("'covariance'", "KeyError")),
    "unknown name": (put("covariance", "names", 0, "joint.1.b"), ("'covariance.names'", "'joint.1.b'", "Did you mean")),
    "name twice": (put("covariance", "names", 0, "joint.2.d"), ("'covariance.names'", "twice")),
    "joint removed": (drop("arm", "joint", 0), ("'covariance.names'", "'joint.2.d'", "no parameter of the arm")),
    "no combination": (
        drop("identifiability", "lost", 0, "combination"),
        ("'identifiability.lost.1.combination'", "parameters and weights"),
    ),
    "unknown lost": (
        put("identifiability", "lost", 0, "combination", {"foo": 1.0}),
        ("'identifiability.lost.1.combination'", "'foo'"),
    ),
    "lost weight": (
        put("identifiability", "lost", 0, "combination", {"joint.2.d": "1"}),
        ("'identifiability.lost.1.combination'", "got 1 for joint.2.d"),
    ),
    "no remedy": (drop("identifiability", "lost", 0, "remedy"), ("'identifiability.lost.1.remedy'",)),
    "lost a text": (put("identifiability", "lost", ["x"]), ("'identifiability.lost.1.combination'",)),
    "noise of another arm": (
        put("provenance", "noise", "encoder_rad", [1e-5] * 4),
        ("'provenance.noise.encoder_rad'", "3 positive numbers"),
    ),
    "negative scatter": (
        put("fit", {"reading_scatter": {"touch_mm": -0.01}}),
        ("'fit.reading_scatter.touch_mm'", "'-0.01'", "expected a positive number", "calibrate again"),
    ),
    "scatter in words": (
        put("fit", {"reading_scatter": {"unexplained_mm": "some"}}),
        ("'fit.reading_scatter.unexplained_mm'", "'some'"),
    ),
    "scatter of no number": (
        put("fit", {"reading_scatter": {"degrees_of_freedom": True}}),
        ("'fit.reading_scatter.degrees_of_freedom'", "'True'"),
    ),
    "scatter no table": (put("fit", {"reading_scatter": [0.1]}), ("'fit.reading_scatter'", "expected a table")),
    "negative noise": (put("provenance", "noise", "encoder_rad", 0, -1e-5), ("'provenance.noise.encoder_rad'",)),
}


@pytest.mark.parametrize("case", CASES)
def test_what_a_damaged_result_is_told(tmp_path: Path, case: str) -> None:
    change, fragments = CASES[case]
    whole = document(tmp_path)
    change(whole)
    with pytest.raises(UlnaInputError) as caught:
        measured(tmp_path, whole)
    says(str(caught.value), f"{tmp_path / 'result.json'}: ", *fragments)


def test_a_sound_result_is_taken_also_where_nothing_could_be_estimated(tmp_path: Path) -> None:
    whole = document(tmp_path)
    whole["identifiability"]["lost"] = []
    assert measured(tmp_path, whole)["u_x"][0] > 0
    whole["covariance"]["matrix"] = [[None] * 3] * 3
    assert measured(tmp_path, whole)["u_x"][0] is None
    whole["covariance"] = {"names": [], "matrix": []}
    assert measured(tmp_path, whole)["u_x"][0] > 0  # the encoders' noise alone


def test_the_scatter_of_a_result_is_in_every_point(tmp_path: Path) -> None:
    """Beside what the parameters and the encoders make of it, in each coordinate alike."""
    whole = document(tmp_path)
    whole["identifiability"]["lost"] = []
    alone = measured(tmp_path, whole)
    whole["fit"] = {"reading_scatter": {"factor": 2.0, "unexplained_mm": 0.03}}
    whole["provenance"]["noise"]["seat_mm"] = 0.04
    more = measured(tmp_path, whole)
    for axis in ("u_x", "u_y", "u_z"):
        assert more[axis][0] ** 2 - alone[axis][0] ** 2 == pytest.approx(0.03**2 + 0.04**2, rel=1e-6)


def test_why_no_uncertainty_can_be_given_is_told(tmp_path: Path) -> None:
    """No degrees of freedom; or a loss and too few readings for each parameter."""
    whole = document(tmp_path)
    whole["identifiability"]["lost"] = []
    whole["covariance"]["matrix"] = [[None] * 3] * 3
    counts = {"observations": 60, "placement_unknowns": 20, "degrees_of_freedom": 15.0, "loss": "huber"}
    for fit, said in (
        (None, "the calibration had no degrees of freedom"),
        (counts | {"degrees_of_freedom": 0.0}, "the calibration had no degrees of freedom"),
        (counts, "with loss 'huber' the calibration had 1.6 equations for each parameter, and of fewer than 2.5"),
        (counts | {"loss": "none"}, "held parameters of an earlier one that gave no uncertainties"),
    ):
        whole["fit"] = fit
        path = tmp_path / "result.json"
        path.write_text(json.dumps(whole | {"parameters": parameters(tmp_path, whole)}))
        (note,) = ulna.measure(path, np.zeros((1, 3)), "bent").notes
        assert said in note
        with pytest.raises(UlnaInputError) as caught:
            check_known(Arm.load(path))
        says(str(caught.value), said, "more readings" if fit is None else "")
