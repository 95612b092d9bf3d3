"""Run rules: each on figures made for it, and how long figures without a cause stay unfound, as published."""

from __future__ import annotations

import numpy as np
import pytest

from ulna.control.runs import RULES, USUAL, runs
from ulna.ground.errors import UlnaInputError

#: rule → figures in s that it finds, and at which place it does
MADE = {
    "beyond-3s": ([0.1, -0.2, 3.1, 0.4], (2, 2)),
    "two-of-three": ([0.1, -2.1, 0.5, -2.4, 0.3], (1, 3)),
    "four-of-five": ([0.2, 1.1, 1.2, -0.4, 1.3, 1.4, 0.0], (1, 5)),
    "eight-on-one-side": ([-0.3, 0.2, 0.1, 0.5, 0.4, 0.2, 0.6, 0.1, 0.3, -0.2], (1, 8)),
    "six-rising": ([0.5, -0.8, -0.5, -0.1, 0.2, 0.3, 0.9, 0.1], (1, 6)),
    "fourteen-alternating": ([0.6, -0.5] * 7 + [-0.5], (0, 13)),
    "fifteen-near": ([1.2, *[0.4, -0.3, 0.2] * 5, -1.4], (1, 15)),
    "eight-apart": ([0.1, 1.2, -1.3, 1.1, -1.5, 1.3, 1.6, -1.2, -1.1, 0.2], (1, 8)),
}
#: Champ and Woodall, Technometrics 29 (1987) 393, table 1, no shift: rules → average run length
RUN_LENGTHS = {
    ("beyond-3s",): 370.40,
    ("beyond-3s", "two-of-three"): 225.44,
    ("beyond-3s", "four-of-five"): 166.05,
    ("beyond-3s", "eight-on-one-side"): 152.73,
    ("beyond-3s", "two-of-three", "four-of-five", "eight-on-one-side"): 91.75,
}


@pytest.mark.parametrize("name", RULES)
def test_a_rule_finds_what_it_is_for(name: str) -> None:
    z, place = MADE[name]
    for sign in (1.0, -1.0):
        found = runs(10.0 + 2.0 * sign * np.array(z), 10.0, 2.0, [name]).found
        assert [(run.rule, run.first, run.last) for run in found] == [(name, *place)]
        if name in USUAL:
            assert found[0].upward == (sign * (1.0 if name != "two-of-three" else -1.0) > 0.0)
    short = runs(np.delete(np.array(z), place[0]), 0.0, 1.0, [name])
    assert short.found == ()


def test_every_rule_has_its_case() -> None:
    assert set(MADE) == set(RULES)
    assert set(USUAL) < set(RULES)


def test_rows_that_overlap_are_one_run_and_it_is_known_which_end_now() -> None:
    found = runs([1.0] * 12, 0.0, 2.0, ["eight-on-one-side"])
    assert [(run.first, run.last) for run in found.found] == [(0, 11)]
    assert found.ending(11) == found.found
    assert found.ending(10) == ()
    few = runs([1.0, 2.0], 0.0, 2.0)
    assert few.not_asked == USUAL[1:]
    assert (few.basis.n, few.basis.method) == (2, "run rules")


@pytest.mark.parametrize("rules", RUN_LENGTHS, ids="+".join)
def test_run_lengths_are_those_published(rules: tuple[str, ...]) -> None:
    """2000 histories, to four of their standard errors; none is longer than 5000."""
    rng = np.random.default_rng(7)
    lengths = []
    for _ in range(2000):
        z = rng.standard_normal(5000)
        for most in (200, 1000, 5000):
            found = runs(z[:most], 0.0, 1.0, rules).found
            if found:
                break
        lengths.append(min(_first(z, run, rules) for run in found))
    assert np.mean(lengths) == pytest.approx(RUN_LENGTHS[rules], abs=4.0 * np.std(lengths) / np.sqrt(2000))


def _first(z: np.ndarray, run, rules: tuple[str, ...]) -> int:
    """Figures until a run was first seen: at most its rule's length after it began."""
    for last in range(run.first, run.last + 1):
        if any(each.rule == run.rule for each in runs(z[run.first : last + 1], 0.0, 1.0, rules).found):
            return last + 1
    return run.last + 1


def test_what_is_no_rule_is_said() -> None:
    with pytest.raises(UlnaInputError, match=r"got 'six-risin', no rule. Did you mean 'six-rising'"):
        runs([1.0], 0.0, 1.0, ["six-risin"])
    with pytest.raises(UlnaInputError, match="expected a standard deviation above 0"):
        runs([1.0], 0.0, 0.0)
