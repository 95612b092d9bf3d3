"""Angles of joints in plots: as they are within a turn, else one turn wide, not torn where the readings are."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ulna.documents.content.clouds import folded_rad

TURN = 2.0 * np.pi
angles = st.lists(st.floats(-60.0, 60.0), min_size=1, max_size=40).map(np.array)


@given(angles)
def test_it_is_the_same_posture_and_at_most_a_turn_wide(angle_rad: np.ndarray) -> None:
    found = folded_rad(angle_rad)
    turns = (found - angle_rad) / TURN
    assert turns == pytest.approx(np.round(turns), abs=1e-9)
    assert np.ptp(found) <= TURN + 1e-9
    if np.ptp(angle_rad) <= TURN:
        assert found is angle_rad


@given(angles, st.integers(-3, 3))
def test_whole_turns_change_nothing_once_it_is_folded(angle_rad: np.ndarray, turns: int) -> None:
    wide = np.concatenate([angle_rad, [angle_rad.min() - 7.0, angle_rad.max() + 7.0]])
    found, moved = folded_rad(wide), folded_rad(wide + TURN * turns)
    # but at the edge itself, where rounding may put a reading on either side
    apart = np.abs(np.exp(1j * found) - np.exp(1j * moved))
    assert apart.max() < 1e-6


def test_a_cluster_about_the_encoders_zero_is_not_torn() -> None:
    around = np.linspace(-0.4, 0.4, 50)
    found = folded_rad(np.concatenate([around, around + TURN, around + 3 * TURN]))
    assert np.ptp(found) == pytest.approx(0.8, abs=1e-9)
    assert np.abs(found).max() == pytest.approx(0.4, abs=1e-9)
