"""The ways of the literature on the same two arms: what each determines, and how right the arm is that it finds."""

from __future__ import annotations

import json
from dataclasses import replace
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from ulna.arm.arm import Arm
from ulna.arm.probe import Probe
from ulna.ground.errors import UlnaInputError
from ulna.reproduce import STUDIES
from ulna.reproduce.ways import comparison, trial
from ulna.reproduce.ways.arms import ARMS, BAR_MM, SEVEN, SIX, true_arm
from ulna.reproduce.ways.work import Rerun, outcomes_table

pytestmark = [pytest.mark.slow, pytest.mark.long]

QUICK = ("shimojima2002", "santolaria2010", "wang2007", "cheng2010")
SEARCHING = ("gao2009", "wang2010")
MODULES = {module.WORK.name: module for module in comparison.WORKS}


@pytest.fixture(scope="module")
def quick() -> dict[str, Rerun]:
    """The works whose every fit is Levenberg–Marquardt, in full."""
    return {name: MODULES[name].run(None, None) for name in QUICK}


@pytest.fixture(scope="module")
def searching() -> dict[str, Rerun]:
    """The others, once, their searches cut short: what finishes them must find the optimum all the same."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(trial, "BUDGET", 5000)
        return {name: MODULES[name].run(None, None, repeats=1) for name in SEARCHING}


def printed(renderable: object) -> str:
    text = StringIO()
    Console(width=80, file=text).print(renderable)
    return "\n".join(line.rstrip() for line in text.getvalue().splitlines())


@pytest.mark.parametrize("name", QUICK)
def test_what_the_works_report_comes_out(quick, name):
    for claim in quick[name].claims():
        assert claim.agrees is not False, claim


@pytest.mark.parametrize("name", SEARCHING)
def test_searches_finished_by_lm_reach_its_optimum(searching, name):
    claims = [claim for claim in searching[name].claims() if claim.agrees is not None]
    assert claims
    for claim in claims:
        assert claim.agrees, claim


#: way → parameters that it leaves open: 2 the base frame, 1 the scale, with one seat of unknown place all of that
LEFT_OPEN = {
    "ball plate": 2,
    "14-ball bar": 2,
    "… its points alone": 3,
    "… its lengths alone": 2,
    "coordinates, frame known": 0,
    "coordinates, frame unknown": 2,
    "one seat, known": 0,
    "one seat, unknown": 3,
    "bar, 140 places": 2,
    "probe from one seat": 0,
}


def test_what_each_way_determines(quick, searching):
    seen = set()
    for found in (*quick.values(), *searching.values()):
        for outcome in found.outcomes:
            if outcome.parameters is None:
                continue
            seen.add(outcome.way)
            expected = 3 if outcome.way == "probe from one seat" else {SEVEN: 27, SIX: 23}[outcome.arm]
            assert outcome.parameters == expected
            assert outcome.parameters - outcome.determined == LEFT_OPEN[outcome.way], outcome.way
    assert seen == set(LEFT_OPEN)


def test_every_way_that_knows_the_scale_measures_as_well_as_noise_lets_it(quick):
    for found in quick.values():
        for outcome in found.outcomes:
            if "points alone" in outcome.way:
                assert outcome.bars_by_arm_rms_mm > 0.05  # as wrong as the drawing's scale
                continue
            assert outcome.bars_by_arm_rms_mm < 0.01
            assert outcome.bars_rms_mm < 0.016  # noise alone: 0.012
            assert outcome.worst_point_mm < 0.03
            assert outcome.bars_rms_mm < 0.01 * outcome.start_bars_rms_mm


def test_uncertainties_cover_the_truth(quick):
    shares = [outcome.within_2u for found in quick.values() for outcome in found.outcomes]
    assert np.mean(shares) == pytest.approx(0.954, abs=0.03)
    assert min(shares) > 0.85


def scaled(arm: Arm, factor: float) -> Arm:
    """Every length of the arm longer by a factor."""
    joints = tuple(replace(joint, a_mm=joint.a_mm * factor, d_mm=joint.d_mm * factor) for joint in arm.joints)
    probes = {name: Probe(*(probe.tip_mm * factor).tolist()) for name, probe in arm.probes.items()}
    return replace(arm, joints=joints, probes=probes)


@pytest.mark.parametrize("name", ARMS)
def test_the_judge_sees_what_is_wrong(name):
    """An arm too long by one part in a thousand: every bar is, and the worst point is the farthest from the middle."""
    truth = true_arm(name)
    found = trial.errors_of(scaled(truth.arm, 1.001), truth, 5)
    exact = trial.errors_of(truth.arm, truth, 5)
    np.testing.assert_allclose(found.bars_by_arm_mm, 0.001 * (BAR_MM + exact.bars_mm), rtol=0, atol=1e-9)
    assert not exact.bars_by_arm_mm.any()
    assert exact.worst_point_mm < 1e-9
    reach = np.linalg.norm(truth.arm.tip(truth.anywhere(5000, np.random.default_rng(1))), axis=1).max()
    assert 0.8e-3 * reach < found.worst_point_mm < 1.4e-3 * reach


@pytest.mark.parametrize("features", ["line", "plate"])
def test_an_artefact_keeps_its_shape_wherever_it_stands(features):
    truth = true_arm(SIX)
    at = np.array([[0.0, 0, 0], [90.0, 0, 0], [200.0, 0, 0]])
    if features == "plate":
        at = np.array([[0.0, 0, 0], [90.0, 0, 0], [0.0, 150.0, 30.0], [40.0, 0, -60.0]])
    stands = truth.places(at, 20, np.random.default_rng(2))
    for place in stands:
        apart, expected = (np.linalg.norm(x[:, None] - x[None], axis=2) for x in (place, at))
        np.testing.assert_allclose(apart, expected, rtol=0, atol=1e-9)
        if features == "plate":  # and is not mirrored
            turned, plain = (np.linalg.det(x[1:] - x[0]) for x in (place, at))
            assert turned == pytest.approx(plain)
    q_rad = truth.touch(stands.reshape(-1, 3), 3, np.random.default_rng(3))
    assert (q_rad >= truth.travel_rad[:, 0] - 1e-4).all()
    assert (q_rad <= truth.travel_rad[:, 1] + 1e-4).all()
    off = np.linalg.norm(truth.arm.tip(q_rad) - stands.reshape(-1, 3), axis=1)
    assert 0.005 < np.sqrt((off**2).mean() / 3) < 0.012


def test_what_is_out_of_reach_is_told():
    truth = true_arm(SEVEN)
    with pytest.raises(ValueError, match="out of the virtual arm's reach"):
        truth.touch(np.array([[5000.0, 0.0, 0.0]]), 1, np.random.default_rng(1))
    with pytest.raises(UlnaInputError, match="only 0 of 2 places"):
        truth.places(np.array([[0.0, 0, 0], [9000.0, 0, 0]]), 2, np.random.default_rng(1))


def test_the_locked_arm_is_the_same_arm():
    seven, six = true_arm(SEVEN).arm, true_arm(SIX).arm
    q = true_arm(SEVEN).anywhere(50, np.random.default_rng(1))
    q[:, 6] = 0.0
    np.testing.assert_allclose(six.tip(q[:, :6]), seven.tip(q), rtol=0, atol=1e-9)


def test_what_is_saved(quick, tmp_path: Path):
    found = quick["shimojima2002"]
    found.save(tmp_path / "out")
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "shimojima2002.json",
        "table-1.csv",
        "table-2.csv",
        "tables.tex",
    ]
    written = json.loads((tmp_path / "out" / "shimojima2002.json").read_text("utf-8"))
    assert written == json.loads(json.dumps(found.as_dict()))
    assert written["format"] == "ulna-reproduction/1"
    assert {entry["arm"] for entry in written["outcomes"]} == set(ARMS)
    with pytest.raises(UlnaInputError, match="exists already"):
        found.save(tmp_path / "out")


def test_one_table_and_one_picture_over_all(quick, searching, tmp_path: Path):
    outcomes = [outcome for found in (*quick.values(), *searching.values()) for outcome in found.outcomes]
    whole = comparison.Comparison(outcomes)
    whole.save(tmp_path / "out")
    names = ["all.json", "table-1.csv", "tables.tex", "ways.pdf", "ways.png", "ways.svg"]
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == names
    written = json.loads((tmp_path / "out" / "all.json").read_text("utf-8"))
    assert len(written["outcomes"]) == len(outcomes)
    text = printed(whole.table())
    assert max(map(len, text.splitlines())) <= 80
    for way in LEFT_OPEN:
        assert way in text


def test_every_way_is_compared_once():
    ways = comparison.all_ways()
    assert len({way.label for way in ways}) == len(ways)
    assert {way.label for way in ways} > set(LEFT_OPEN)


def test_the_true_arm_has_noise_alone():
    (way,) = (way for way in comparison.all_ways() if way.label == "the true arm")
    truth = true_arm(SEVEN)
    done = way.carry_out(truth, 1)
    assert (done.touches, done.result, done.off_over_u) == (0, None, [])
    assert done.arm is truth.arm


@pytest.mark.parametrize("name", QUICK)
def test_the_docs_show_what_is_found(quick, root, name):
    """All but the times; the works that search take minutes and are shown as `make docs-output` found them."""
    claims = printed(quick[name].table()).split("\nOn the same two arms")[0]
    assert (root / "docs" / "output" / f"ways-{name}.txt").read_text("utf-8").split() == claims.split()
    shown = (root / "docs" / "output" / "ways-all.txt").read_text("utf-8").splitlines()
    lines = {tuple(line.split()[:-1]) for line in shown}
    rows = printed(outcomes_table(quick[name].outcomes)).split("\n")
    rows = [row for row in rows if "/" in row and row.split()[-1].replace(".", "").isdigit()]
    assert len(rows) == len(quick[name].outcomes)
    for row in rows:
        assert tuple(row.split()[:-1]) in lines, row


def test_it_fits_a_terminal_of_80_columns(quick, searching):
    for found in (*quick.values(), *searching.values()):
        text = printed(found.table())
        assert max(map(len, text.splitlines())) <= 80
        assert found.work.title in text.splitlines()[0]


def test_the_registry_names_them_all():
    assert {name for name in STUDIES if name not in ("cheng2011", "all")} == set(MODULES)
    for name, module in MODULES.items():
        assert STUDIES[name][1] == module.__name__
        assert name[-4:] in STUDIES[name][0]
    assert STUDIES["all"][1] == comparison.__name__
