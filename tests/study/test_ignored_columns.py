"""Columns that a study says it does not use: whatever they are called, and whatever stands in them."""

from __future__ import annotations

import numpy as np
import pytest
from tests.small_study import BARS, SmallStudy, says


@pytest.fixture
def small(tmp_path):
    """With two columns more, whose names are nearly, or quite, one that Ulna knows, and no numbers in them."""
    study = SmallStudy(tmp_path)
    lines = BARS.splitlines()
    rows = [f"{lines[0]},Temperatur,temperature", *(f"{line},warm,cold" for line in lines[1:])]
    study.write("bars.csv", "\n".join(rows) + "\n")
    return study


def test_ignored_columns_are_not_looked_at(small: SmallStudy) -> None:
    (small.folder / "plain").mkdir()
    plain = SmallStudy(small.folder / "plain")
    small.swap("study.toml", 'probe = "bent"', 'probe = "bent"\nignore = ["Temperatur", "temperature"]')
    study, warned = small.load()
    assert not [message for message in warned if "not used" in message]
    np.testing.assert_array_equal(study.readings[0].q_rad, plain.load()[0].readings[0].q_rad)


def test_without_the_key_they_are_asked_about(small: SmallStudy) -> None:
    assert "emperature" in small.error()


@pytest.mark.parametrize(("name", "expected"), [("Temp", "no column 'Temp'"), ("q2", "an angle of a joint")])
def test_names_that_cannot_be_meant(small: SmallStudy, name: str, expected: str) -> None:
    small.swap("study.toml", 'probe = "bent"', f'probe = "bent"\nignore = ["{name}"]')
    says(small.error(), "readings.1.ignore", expected)
