"""What is wrong with a simulation file is told in one message, and nothing is written."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from tests.cli_runs import assert_bad_input, run
from tests.simulations import BALL, BAR, NOISE, true_arm, write

import ulna
from ulna import Probe, UlnaInputError

CASES: dict[str, tuple[str, str, list[str]]] = {
    # name: artefacts, further keys, what the message says
    "no artefact": ("", NOISE, ["key 'artefact' is missing"]),
    "unknown kind": (
        BAR.replace('"bar"', '"bars"'),
        NOISE,
        ["key 'artefact.bar.kind'", "'bars'", "Did you mean 'bar'?"],
    ),
    "unknown key": (BAR, "nois = { seat = 0.008 }", ["unknown key 'nois'", "Did you mean 'noise'?"]),
    "unknown key of an artefact": (
        BAR + "placement = 3\n",
        NOISE,
        ["artefact.bar.placement", "Did you mean 'placements'?"],
    ),
    "no placements": (BAR + "placements = 0\n", NOISE, ["artefact.bar.placements", "got 0", "at least 1"]),
    "a part of a touch": (BAR + "touches = 1.5\n", NOISE, ["artefact.bar.touches", "got 1.5", "whole number"]),
    "negative noise": (BAR, "noise = { seat = -0.1 }", ["noise.seat", "got -0.1", "at least 0"]),
    "noise for the wrong number of joints": (
        BAR,
        "noise = { encoder = [1e-6, 1e-6] }",
        ["noise.encoder", "got 2 numbers", "7"],
    ),
    "one exact encoder": (
        BAR,
        "noise = { encoder = [0.0, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6] }",
        ["noise.encoder", "joint 1"],
    ),
    "noise wider than the travel": (BAR, "noise = { encoder = 1.0 }", ["joint 1", "no travel left"]),
    "not a number": (BAR, "noise = { seat = nan }", ["noise.seat", "finite"]),
    "a word for a drawing": (BAR, 'drawing = "good"', ["key 'drawing'", "'good'", "'exact'"]),
    "limits swapped": (BAR, "travel = { limits = [[2.0, -2.0]] }", ["travel.limits", "joint 1", "Swap"]),
    "limits for some joints": (
        BAR,
        "travel = { limits = [[-1.0, 1.0], [0.0, 1.0]] }",
        ["travel.limits", "got 2 pairs"],
    ),
    "travel beyond the arm's limits": (
        BAR,
        "travel = { limits = [[-4.0, 1.0]] }",
        ["travel.limits", "joint 1", "-3.1 to 3.1"],
    ),
    "temperature of an arm that does not grow": (
        BAR,
        "temperature = { mean = 22.0 }",
        ["key 'temperature'", "expansion"],
    ),
    "most touches missed": (BAR, "missed = { share = 0.9, size = 1.0 }", ["missed.share", "got 0.9", "at most 0.5"]),
    "volume upside down": (BAR, "volume = { low = [0.0, 0.0, 9.0], high = [9.0, 9.0, 0.0] }", ["key 'volume'", "Swap"]),
    "volume out of reach": (
        BAR,
        "volume = { low = [9e3, 0.0, 0.0], high = [9.9e3, 900.0, 900.0] }",
        ["only 0 of 100", "volume"],
    ),
    "bar larger than the arm": (
        BAR.replace("443.172", "9000.0"),
        NOISE,
        ["artefact 'bar'", "only 0 of 100 placements"],
    ),
    "unknown probe": (BAR + 'probe = "bend"\n', NOISE, ["artefact.bar.probe", "'bend'", "Did you mean 'bent'?"]),
    "a probe twice": (BAR + 'probe = ["bent", "bent"]\n', NOISE, ["artefact.bar.probe", "twice"]),
    "lengths of no length": ('[artefact.rows]\nkind = "length"\n', NOISE, ["artefact.rows.length' is missing"]),
    "points of no points": ('[artefact.plate]\nkind = "points"\n', NOISE, ["artefact.plate.features' is missing"]),
    "rows touched twice": (
        '[artefact.r]\nkind = "length"\nlength = 9.0\ntouches = 2\n',
        NOISE,
        ["artefact.r.touches", "got 2"],
    ),
    "a hollow too small": (
        BALL.replace("25.0", "5.0") + "inside = true\n",
        NOISE,
        ["hollow of 5 mm", "6 mm", "smaller ball"],
    ),
    "file names alike": (BAR + BAR.replace("artefact.bar", "artefact.Bar"), NOISE, ["'bar' and 'Bar'", "Rename"]),
    "points of the arm out of reach": (
        '[artefact.t]\nkind = "points"\nframe = "arm"\nfeatures = { a = [500.0, 0.0, 300.0], b = [5e3, 0.0, 0.0] }\n',
        NOISE,
        ["1 of its 2 features", "'b'"],
    ),
    "points of the arm placed twice": (
        '[artefact.t]\nkind = "points"\nframe = "arm"\nplacements = 2\nfeatures = { a = [500.0, 0.0, 300.0] }\n',
        NOISE,
        ["artefact.t.placements", "got 2", "one place"],
    ),
    "unknown extra": (BAR, 'fit = { extras = ["harmonics"] }', ["fit.extras.1", "'harmonics'", "'encoder-harmonics'"]),
}


@pytest.mark.parametrize("case", CASES)
def test_the_message_names_what_is_wrong(tmp_path: Path, case: str) -> None:
    artefacts, more, expected = CASES[case]
    spec = write(tmp_path, artefacts, more)
    with pytest.raises(UlnaInputError) as caught:
        ulna.simulate(spec)
    for part in (str(spec), *expected):
        assert part in str(caught.value)


def test_a_sphere_needs_a_ball(tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match=r"artefact 'ball'.*'bare'.*probe\.bare\.ball"):
        ulna.simulate(write(tmp_path, BALL, NOISE, true_arm({"bare": Probe(0.0, 0.0, 200.0)})))


def test_two_probes_one_must_be_named(tmp_path: Path) -> None:
    arm = true_arm({"short": Probe(0.0, 0.0, 200.0), "long": Probe(0.0, 0.0, 250.0)})
    with pytest.raises(UlnaInputError, match=r"artefact\.bar\.probe'.*2 probes: say which of short, long"):
        ulna.simulate(write(tmp_path, BAR, NOISE, arm))


def test_the_truth_knows_its_signs(tmp_path: Path) -> None:
    arm = true_arm()
    unknown = replace(arm, joints=(replace(arm.joints[0], sign=0), *arm.joints[1:]))
    with pytest.raises(UlnaInputError, match="sign of a joint is 0"):
        ulna.simulate(write(tmp_path, BAR, NOISE, unknown))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "empty"),
        ("format = \n", "not valid TOML"),
        ('format = "ulna-study/1"\n', "ulna-simulation"),
        ('format = "ulna-simulation/2"\n', "ulna-simulation/1"),
        (
            'format = "ulna-simulation/1"\narm = "true.toml"\n[artefact.cone]\nkind = "seat"\n',
            "units are never guessed",
        ),
    ],
)
def test_the_file_itself(tmp_path: Path, text: str, expected: str) -> None:
    spec = write(tmp_path, BAR)
    spec.write_text(text)
    done = run("simulate", spec, "-o", tmp_path / "out")
    assert_bad_input(done, str(spec), expected)
    assert not (tmp_path / "out").exists()


def test_nothing_is_overwritten_unasked_and_no_input_ever(tmp_path: Path) -> None:
    spec = write(tmp_path, BAR)
    assert run("simulate", spec, "-o", tmp_path / "out").returncode == 0
    before = (tmp_path / "out" / "bar.csv").read_bytes()
    assert_bad_input(run("simulate", spec, "-o", tmp_path / "out", "--seed", "9"), "exists already", "--force")
    assert (tmp_path / "out" / "bar.csv").read_bytes() == before
    assert run("simulate", spec, "-o", tmp_path / "out", "--seed", "9", "--force").returncode == 0
    assert (tmp_path / "out" / "bar.csv").read_bytes() != before
    # the true arm in the place where truth.toml goes
    truth = tmp_path / "truth.toml"
    (tmp_path / "true.toml").rename(truth)
    spec.write_text(spec.read_text().replace('"true.toml"', '"truth.toml"'))
    kept = truth.read_bytes()
    assert_bad_input(run("simulate", spec, "-o", tmp_path, "--force"), "truth.toml", "input of this run")
    assert truth.read_bytes() == kept


def test_missing_files(tmp_path: Path) -> None:
    assert_bad_input(run("simulate", tmp_path / "none.toml"), "none.toml", "no such file")
    spec = write(tmp_path, BAR)
    (tmp_path / "true.toml").unlink()
    assert_bad_input(run("simulate", spec), "true.toml", "no such file")
