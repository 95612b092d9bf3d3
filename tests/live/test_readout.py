"""The read-out: a virtual arm's stream, read with what its calibration knows; and `ulna live measure`."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console
from tests.cli_runs import BENT, STRAIGHT, assert_bad_input, run
from tests.live.hands import DWELL, NOISE_RAD, RATE_HZ, TRAVEL, hand, near, source

import ulna
from ulna import Arm, UlnaInputError
from ulna.arm.covariance import root_of
from ulna.arm.effects.effects import Effects
from ulna.arm.joint import Joint
from ulna.cli.printed.readout import large, screen, summary
from ulna.ground.arrays import F64
from ulna.live.features import Notebook, asked_for
from ulna.live.figures import Calibrated
from ulna.live.postures import folded, near_stops
from ulna.live.readout import ReadOut, Said, Set, Tip
from ulna.live.rounds import Round
from ulna.live.source import SourceEnded
from ulna.live.stream import Stream, streaming
from ulna.live.trigger import Refused


def read(stream: Stream, out: ReadOut, tips: bool = False) -> list[Said]:
    """All that is said of a stream."""
    said: list[Said] = []
    while True:
        try:
            said += out.take(stream.read(0.1), tips)
        except SourceEnded:
            return said


def reached(arm: Arm, q_rad: F64, target_mm: F64) -> F64:
    """A pose near another one whose tip is in a place."""
    for _ in range(30):
        off = target_mm - arm.core.tip(q_rad[None], 0)[0]
        q_rad = q_rad + np.linalg.pinv(arm.core.encoder_jacobian(q_rad[None], 0)[0]) @ off
    assert np.linalg.norm(arm.core.tip(q_rad[None], 0)[0] - target_mm) < 1e-9
    return q_rad


def test_the_tip_and_its_u_are_those_of_measure(result: Path, tmp_path: Path) -> None:
    q_rad = hand(near(3))
    arm = Calibrated(result, "bent")
    with streaming(source(tmp_path, q_rad)) as stream:
        out = ReadOut(stream, arm, Notebook())
        tips = [each for each in read(stream, out, tips=True) if isinstance(each, Tip)]
        newest = out.now()
    assert len(tips) > 0.9 * len(q_rad) / RATE_HZ / 0.1
    assert newest is not None
    assert newest.q_rad.tolist() == q_rad[-1].tolist()
    measured = ulna.measure(result, np.array([each.q_rad for each in tips]), "bent")
    assert measured.u_mm is not None
    for each, point_mm, u_mm in zip(tips, measured.points_mm, measured.u_mm, strict=True):
        at = arm.arm.core.tip(each.q_rad[None], 0)[0]
        np.testing.assert_array_equal([figure.value for figure in each.figures], at)
        np.testing.assert_array_equal(at, point_mm)
        np.testing.assert_allclose([figure.u for figure in each.figures], u_mm, rtol=1e-9)
        # Student's t: the calibration, of 76 degrees of freedom, scaled its covariance by what its residuals showed
        assert all(2.0 < (figure.k or 0.0) < 2.04 for figure in each.figures)


def test_u_holds_the_truth_as_often_as_it_says(result: Path) -> None:
    """Arms drawn from the covariance, 200 points of each; encoders and touches with the noise that the
    calibration found."""
    arm = Calibrated(result, "bent")
    known = arm.arm.uncertainty
    assert known is not None
    root = root_of(known.over(arm.arm.parameter_names))
    rng = np.random.default_rng(11)
    inside, lengths = [], []
    for _ in range(10):
        true = arm.arm.core.with_parameters(arm.arm.parameters + root @ rng.standard_normal(len(root)))
        q_rad = rng.uniform(-2.0, 2.0, (200, 7))
        truth = true.tip(q_rad, 0) + np.sqrt(arm.noise.variance_mm2) * rng.standard_normal((200, 3))
        assert arm.noise.encoder_rad is not None
        shown = q_rad + arm.noise.encoder_rad * rng.standard_normal(q_rad.shape)
        for pose, place in zip(shown, truth, strict=True):
            for figure, value in zip(arm.point(pose), place, strict=True):
                assert figure.value is not None
                assert figure.expanded is not None
                inside.append(abs(figure.value - value) <= figure.expanded)
        for a, b in zip(range(0, 200, 2), range(1, 200, 2), strict=True):
            (figure,) = arm.figures("length", [shown[a], shown[b]], "l")
            assert figure.value is not None
            assert figure.expanded is not None
            lengths.append(abs(figure.value - np.linalg.norm(truth[b] - truth[a])) <= figure.expanded)
    assert 0.93 <= np.mean(inside) <= 0.97
    assert 0.93 <= np.mean(lengths) <= 0.97


def test_a_probe_that_was_not_calibrated_has_words_and_no_number(result: Path, tmp_path: Path) -> None:
    poses = near(2)
    with streaming(source(tmp_path, hand(poses))) as stream:
        out = ReadOut(stream, Calibrated(result, "straight"), Notebook(), by_itself=True)
        said = read(stream, out, tips=True)
        text = " ".join(summary(out))
    figures = [figure for each in said if isinstance(each, Tip) for figure in each.figures]
    figures += [figure for each in said if isinstance(each, Set) for figure in each.point.figures]
    assert len(figures) > 100
    assert all(figure.value is None and figure.expanded is None for figure in figures)
    assert all("no reading was taken with probe straight" in str(figure.why) for figure in figures)
    assert "not determined: " in text
    assert "±" not in text
    # what the probe's tip has in common is not the length's alone: nor is that known
    (length,) = Calibrated(result, "straight").figures("length", poses, "l")
    assert length.value is None


def test_an_arm_without_uncertainty_says_so(result: Path, tmp_path: Path) -> None:
    Arm.load(result).save(tmp_path / "arm.toml")
    arm = Calibrated(tmp_path / "arm.toml", "bent", encoder_u_rad=NOISE_RAD)
    figures = arm.point(near(1)[0])
    assert [figure.u for figure in figures] == [None] * 3
    assert [figure.value for figure in figures] == arm.arm.core.tip(near(1)[0][None], 0)[0].tolist()
    done = run("live", "measure", tmp_path / "arm.toml", source(tmp_path, hand(near(2))), "--probe", "bent", "--still")
    assert_bad_input(done, "how its encoders scatter is not known", "--encoder-u")
    done = run(
        "live",
        "measure",
        tmp_path / "arm.toml",
        tmp_path / "source.toml",
        "--probe",
        "bent",
        "--still",
        "--encoder-u",
        "5e-6",
    )
    assert done.returncode == 0, done.stderr
    assert "No U: no uncertainty is known of this arm" in done.stderr
    assert "p2: x " in done.stdout
    assert "±" not in done.stdout


def test_a_still_touch_is_taken_once_and_a_moving_one_refused(result: Path, tmp_path: Path) -> None:
    poses = near(3)
    q_rad = np.concatenate([hand(poses), hand(poses[-1:], seed=2, dwell=4 * DWELL)])  # rests on: no second touch
    with streaming(source(tmp_path, q_rad)) as stream:
        out = ReadOut(stream, Calibrated(result, "bent"), Notebook(), by_itself=True)
        points = [each.point for each in read(stream, out) if isinstance(each, Set)]
    assert [point.name for point in points] == ["p1", "p2", "p3"]
    for point, pose in zip(points, poses, strict=True):
        assert np.abs(point.q_rad - pose).max() < NOISE_RAD
        assert point.spread_mm < 0.02
    assert np.linalg.norm(np.diff([[f.value for f in p.figures] for p in points[:2]], axis=0)) > 2.0

    moving = hand(poses)[: DWELL + TRAVEL // 2]  # ends on its way
    with streaming(source(tmp_path, moving)) as stream:
        out = ReadOut(stream, Calibrated(result, "bent"), Notebook())
        assert isinstance(out.ask(), Refused)  # nothing came yet
        assert read(stream, out) == []  # nobody asked
        answer = out.ask()
        tip = out.now()
    assert isinstance(answer, Refused)
    assert "while touching: hold still" in answer.reason
    assert tip is not None
    assert tip.stillness is not None
    assert not tip.stillness.still
    assert out.notebook.points == []

    with streaming(source(tmp_path, hand(poses[:1]))) as stream:
        out = ReadOut(stream, Calibrated(result, "bent"), Notebook())
        read(stream, out)
        assert isinstance(out.ask(), Set)


def test_what_is_wrong_with_the_stream_is_no_touch(result: Path, tmp_path: Path) -> None:
    q_rad = hand(near(2))
    reset = np.concatenate([q_rad, hand([np.zeros(7)], seed=3)])  # counts from zero again, and rests
    with streaming(source(tmp_path, reset)) as stream:
        out = ReadOut(stream, Calibrated(result, "bent"), Notebook(), by_itself=True)
        assert len([each for each in read(stream, out) if isinstance(each, Set)]) == 2
        tip = out.now()
        refused = out.ask()
        assert tip is not None
        assert all(figure.value is None for figure in tip.figures)
        assert "the angles may be wrong" in str(tip.figures[0].why)
        assert isinstance(refused, Refused)
        assert "the angles may be wrong" in refused.reason
        out.trust()
        again = out.now()
        assert again is not None
        assert again.figures[0].value is not None
        assert isinstance(out.ask(), Set)
    done = run("live", "measure", result, tmp_path / "source.toml", "--probe", "bent", "--still")
    assert done.returncode == 0, done.stderr
    assert "reset: " in done.stderr
    assert "not determined: the angles may be wrong" in done.stdout
    assert "Doubtful" in done.stdout
    done = run("live", "measure", result, tmp_path / "source.toml", "--probe", "bent", "--still", "--json")
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    assert [line["fault"]["kind"] for line in lines if "fault" in line] == ["reset"]
    last = [line["tip"] for line in lines if "tip" in line][-1]
    assert last["x"]["value"] is None
    assert "the angles may be wrong" in last["x"]["not_determined"]
    assert lines[-1]["end"] | {"ended": ""} == {
        "samples": len(reset),
        "faults": {"reset": 1, "ended": 1},
        "doubtful": True,
        "ended": "",
        "points": 2,
    }


def test_features(result: Path, tmp_path: Path) -> None:
    arm = Arm.load(result)
    rng = np.random.default_rng(8)
    first = near(1)[0]
    centre = arm.core.tip(first[None], 0)[0]
    ball = [centre + 12.5 * each / np.linalg.norm(each) for each in rng.normal(size=(8, 3))]
    normal = np.array([1.0, 2.0, 2.0]) / 3.0
    flat = [each - normal * (normal @ (each - centre)) for each in ball[:5]]
    poses = [reached(arm, first, each) for each in [*ball, *flat]]
    kind, asked = asked_for(["ball", "length p1 p2", "distance p9 p10 p11 p12 p13 p1"])
    notebook = Notebook(kind, asked)
    with streaming(source(tmp_path, hand(poses))) as stream:
        out = ReadOut(stream, Calibrated(result, "bent"), notebook, by_itself=True)
        for frames in iter(lambda: _read(stream), None):
            for said in out.take(frames):
                if isinstance(said, Set) and said.point.name == "p8":
                    notebook.new()
                    for _ in range(2):  # circle, plane
                        notebook.turn_kind()
        lines = summary(out)
    assert [point.name for point in notebook.points] == [f"p{k}" for k in range(1, 14)]
    sphere, plane = notebook.features
    assert (sphere.kind, plane.kind) == ("ball", "plane")
    found = {figure.name: figure for figure in out.figures(sphere)}
    assert _within(found["diameter"], 25.0)
    assert all(_within(found[axis], centre[k]) for k, axis in enumerate("xyz"))
    assert abs(found["form"].value or 1.0) < 0.005
    turned = {figure.name: figure for figure in out.figures(plane)}
    assert all(_within(turned[f"n_{axis}"], -np.sign(normal @ centre) * normal[k]) for k, axis in enumerate("xyz"))
    assert _within(turned["d"], abs(float(normal @ centre)))
    measured = ulna.measure(result, np.array([point.q_rad for point in notebook.points]), "bent")
    length = measured.length(0, 1)
    (figure,) = out.figures(asked[0].of(notebook.points))  # type: ignore[arg-type]
    assert figure.value == pytest.approx(length.value_mm, rel=1e-12)
    assert figure.u == pytest.approx(length.u_mm, rel=1e-6)
    (off,) = out.figures(asked[1].of(notebook.points))  # type: ignore[arg-type]
    assert _within(off, float(-np.sign(normal @ centre) * (normal @ (ball[0] - centre))))
    assert any(line.startswith("length p1 p2: length ") for line in lines)
    back = notebook.take_back()
    assert back is not None
    assert (back.name, notebook.next_name()) == ("p13", "p13")


def test_a_hole_touched_from_within(result: Path, tmp_path: Path) -> None:
    """Of 20 mm by a ball of 4 mm, whose centre goes round on 16 mm; and the same points as a shaft's."""
    arm, first = Arm.load(result), near(1)[0]
    centre = arm.core.tip(first[None], 0)[0]
    angle = np.arange(8) / 8.0 * 2.0 * np.pi
    ring = centre + 8.0 * np.array([np.cos(angle), np.sin(angle), 0.0 * angle]).T
    poses = [reached(arm, first, each) for each in ring]
    with streaming(source(tmp_path, hand(poses))) as stream:
        calibrated = Calibrated(result, "bent", inside=True)
        probes = dict(calibrated.arm.probes)
        probes["bent"] = replace(probes["bent"], ball_mm=4.0)
        calibrated.arm = replace(calibrated.arm, probes=probes, uncertainty=calibrated.arm.uncertainty)
        out = ReadOut(stream, calibrated, Notebook("circle"), by_itself=True)
        read(stream, out)
        found = {figure.name: figure for figure in out.figures(out.notebook.current)}
        lines = summary(out)
    assert list(found) == ["x", "y", "z", "diameter", "n_x", "n_y", "n_z", "form"]
    assert _within(found["diameter"], 20.0)
    assert all(_within(found[axis], centre[k]) for k, axis in enumerate("xyz"))
    assert abs(found["n_z"].value or 0.0) == pytest.approx(1.0, abs=1e-5)
    assert abs(found["form"].value or 1.0) < 0.005
    assert any(line.startswith("f1 circle (p1 … p8): x ") for line in lines)
    calibrated._inside = False
    (shaft,) = (each for each in calibrated.figures("circle", poses, "shaft") if each.name == "diameter")
    assert shaft.value == pytest.approx(12.0, abs=0.01)
    without = Calibrated(replace(calibrated.arm, uncertainty=None), "bent")  # numbers alone
    assert {each.name: each.value for each in without.figures("circle", poses, "shaft")}["diameter"] == shaft.value


def _read(stream: Stream) -> Any:
    try:
        return stream.read(0.1)
    except SourceEnded:
        return None


def _within(figure: Any, truth: float) -> bool:
    """Of a noise much smaller than U of the arm's parameters, which are the truth here."""
    return abs(figure.value - truth) <= figure.expanded


def test_a_length_takes_two_touches_and_lines_say_what_lacks() -> None:
    notebook = Notebook("length")
    for number in range(3):
        notebook.take(_point(f"p{number + 1}", near(3)[number]))
    assert [len(feature.points) for feature in notebook.features] == [2, 1]
    assert [feature.lacking for feature in notebook.features] == [0, 1]
    assert [notebook.take_back().name for _ in range(3)] == ["p3", "p2", "p1"]  # type: ignore[union-attr]
    assert notebook.take_back() is None


def _point(name: str, q_rad: F64) -> Any:
    from ulna.live.features import Point

    return Point(name, q_rad, 30, 0.01, 0.0, 0.0, 0.3, ())


def test_touches_on_a_line_are_no_plane(result: Path) -> None:
    arm = Calibrated(result, "bent")
    first = near(1)[0]
    at = arm.tips_mm(first[None])[0]
    poses = [reached(arm.arm, first, at + np.array([step, 0.0, 0.0])) for step in (0.0, 10.0, 20.0, 30.0)]
    figures = arm.figures("plane", poses, "f1")
    assert all(figure.value is None for figure in figures)
    assert str(figures[0].why).startswith("plane: the 4 points are on a line")


def test_what_no_stream_says_is_asked_for() -> None:
    joint = Joint(a_mm=300.0, effects=Effects(backlash_rad=1e-4))
    with pytest.raises(UlnaInputError, match=r"a stream does not say it\. Measure with `ulna measure`"):
        Calibrated(Arm("loose", (joint, Joint(a_mm=300.0), Joint()), {"ball": BENT}))
    warm = Arm(
        "warm", (Joint(a_mm=300.0, effects=Effects(expansion_per_k=1e-5)), Joint(a_mm=300.0), Joint()), {"ball": BENT}
    )
    with pytest.raises(UlnaInputError, match=r"Give it with --temperature\."):
        Calibrated(warm)
    q_rad = np.array([0.1, 0.2, 0.3])
    values = [figure.value for figure in Calibrated(warm, temperature_c=30.0).point(q_rad)]
    assert values == warm.tip(q_rad, temperature_c=30.0).tolist() != warm.tip(q_rad, temperature_c=20.0).tolist()


def test_near_a_stop_and_folded() -> None:
    joints = [Joint(a_mm=300.0, limits_rad=(-1.0, 1.0)), Joint(a_mm=300.0), Joint(alpha_rad=1.5), Joint()]
    arm = Arm("short", tuple(joints), {"ball": STRAIGHT})
    assert near_stops(arm, np.array([0.99, 0.0, 0.0, 0.0])) == ["joint 1 is 0.6° from its stop"]
    assert near_stops(arm, np.array([-1.02, 0.0, 0.0, 0.0])) == ["joint 1 is 1.1° beyond its limit"]
    assert near_stops(arm, np.array([0.5, 9.0, 0.0, 0.0])) == []
    # all axes parallel: nothing moves along them
    flat = Arm("flat", (Joint(a_mm=300.0), Joint(a_mm=300.0), Joint()), {"ball": BENT})
    (text,) = folded(Calibrated(flat), np.array([0.1, 0.8, 0.0]))
    assert "(0.00, 0.00, 1.00)" in text.replace("-", "")
    bent = Arm("bent", (*joints[1:2], *joints[1:]), {"ball": BENT})
    assert folded(Calibrated(bent), np.array([0.3, 1.2, 0.7, 0.9])) == []


@pytest.mark.parametrize("columns", [60, 80])
@pytest.mark.parametrize("probe", ["bent", "straight"])
def test_the_screen_fits(result: Path, tmp_path: Path, columns: int, probe: str) -> None:
    with streaming(source(tmp_path, hand(near(6)))) as stream:
        out = ReadOut(stream, Calibrated(result, probe), Notebook(*asked_for(["ball", "length p1 p2"])), by_itself=True)
        read(stream, out)
        console = Console(width=columns, file=(tmp_path / "shown").open("w", encoding="utf-8"))
        console.print(screen(out, Round(stream), "p6 taken, f1", keys=True))
    console.file.close()
    lines = (tmp_path / "shown").read_text(encoding="utf-8").splitlines()
    assert max(map(len, lines)) <= columns
    assert len(lines) <= 24
    assert "q end" in lines[-1]
    assert any("not determined" in line for line in lines) == (probe == "straight")


def test_large_signs_differ() -> None:
    assert len({large(sign) for sign in "0123456789-."}) == 12
    assert len({len(line) for line in large("-120.45")}) == 1
