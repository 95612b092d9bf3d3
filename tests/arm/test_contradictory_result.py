"""A result.json whose parts contradict each other is two arms: nothing is measured with it, and nothing certified."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ulna

FOSSIL = Path(__file__).resolve().parents[1] / "data" / "fossils" / "result-1.json"
Change = Callable[[dict[str, Any]], None]


def row(document: dict[str, Any], name: str) -> dict[str, Any]:
    return next(each for each in document["parameters"] if each["name"] == name)


def arm_moved(document: dict[str, Any]) -> None:
    document["arm"]["joint"][1]["a"] += 10.0


def probe_moved(document: dict[str, Any]) -> None:
    document["arm"]["probe"]["straight"]["tip"]["z"] += 1e-3


def value_moved(document: dict[str, Any]) -> None:
    row(document, "joint.2.a")["value"] += 1e-6


def one_struck_out(document: dict[str, Any]) -> None:
    document["parameters"].remove(row(document, "joint.3.alpha"))


def all_struck_out(document: dict[str, Any]) -> None:
    document["parameters"] = []


def one_twice(document: dict[str, Any]) -> None:
    document["parameters"].append(dict(row(document, "joint.2.a")))


def other_unit(document: dict[str, Any]) -> None:
    row(document, "joint.2.a")["unit"] = "rad"


def held_called_fitted(document: dict[str, Any]) -> None:
    row(document, "joint.1.theta0")["status"] = "fitted"


def fitted_called_held(document: dict[str, Any]) -> None:
    row(document, "joint.2.a")["status"] = "held"


def u_halved(document: dict[str, Any]) -> None:
    row(document, "joint.2.a")["u"] *= 0.5


def covariance_grown(document: dict[str, Any]) -> None:
    matrix = document["covariance"]["matrix"]
    document["covariance"]["matrix"] = [[4.0 * value for value in each] for each in matrix]


CHANGES = [
    arm_moved,
    probe_moved,
    value_moved,
    one_struck_out,
    all_struck_out,
    one_twice,
    other_unit,
    held_called_fitted,
    fitted_called_held,
    u_halved,
    covariance_grown,
]


@pytest.mark.parametrize("change", CHANGES)
def test_it_is_refused_wherever_a_result_is_taken(change: Change, tmp_path: Path) -> None:
    document = json.loads(FOSSIL.read_text(encoding="utf-8"))
    path = tmp_path / "result.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    q_rad = np.zeros((1, 5))
    assert ulna.measure(ulna.Result.load(path), q_rad, probe="bent").points_mm.shape == (1, 3)
    change(document)
    path.write_text(json.dumps(document), encoding="utf-8")
    for take in (ulna.Result.load, ulna.Arm.load, lambda each: ulna.measure(each, q_rad, probe="bent")):
        with pytest.raises(ulna.UlnaInputError, match=r"key 'parameters.*The file was changed or damaged"):
            take(path)
