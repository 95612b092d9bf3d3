"""`ulna live commission`, on recordings of a simulated home-built arm and on a terminal."""

from __future__ import annotations

import json
import os
import pty as terminals
import select
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import assert_bad_input, run
from tests.live.home_built import COUNTS, RATE_HZ, HomeBuilt
from tests.live.test_commission import drawn

from ulna.arm.arm import Arm
from ulna.arm.file import save_arm
from ulna.live.commission.posture import posture
from ulna.live.source_file import read_source
from ulna.live.stream import streaming
from ulna.planning.file import load_plan_spec


def write_recording(arm: HomeBuilt, q_rad: np.ndarray, path: Path) -> None:
    raw = arm.counts(q_rad)
    lines = [",".join(arm.hello.channels)] + [",".join(f"{each:.0f}" for each in row) for row in raw]
    path.write_text("\n".join(lines) + "\n")


ARM = {"order": [4, 0, 6, 2, 1, 5], "signs": [1, -1, -1, 1, -1, 1], "channels": 8, "seed": 11}
IN_POSTURE = posture(drawn(6)).turned_rad


@pytest.fixture
def recording(tmp_path: Path) -> HomeBuilt:
    arm = HomeBuilt(**ARM)  # type: ignore[arg-type]
    save_arm(drawn(6), tmp_path / "drawn.toml")
    write_recording(arm, arm.whole(posture_rad=IN_POSTURE), tmp_path / "run.csv")
    return arm


def test_the_files_give_the_true_angles(recording: HomeBuilt, tmp_path: Path) -> None:
    """Up to whole turns, in rad, with the signs and zero offsets of the arm file."""
    out = tmp_path / "found"
    words = f"live commission file:{tmp_path}/run.csv?speed=max&rate={RATE_HZ:g} --arm {tmp_path}/drawn.toml"
    done = run(*words.split(), "--counts-per-turn", "4096", "--yes", "--json", "-o", out)
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert [each["channel"] for each in document["joints"]] == [f"c{k + 1}" for k in recording.order]
    assert [each["sign"] for each in document["joints"]] == recording.signs.tolist()
    noise = 2 * np.pi / COUNTS * np.sqrt(recording.noise**2 + 1 / 12)
    assert [each["noise_rad"] for each in document["joints"]] == pytest.approx([noise] * 6, rel=0.1)

    arm = Arm.load(out / "arm.toml")
    assert arm.signs.tolist() == recording.signs.tolist()
    assert [joint.counts_per_turn for joint in arm.joints] == [COUNTS] * 6
    others = [not name.endswith("theta0") and not name.startswith("probe") for name in arm.parameter_names]
    assert arm.parameters[others] == pytest.approx(drawn(6).parameters[others])
    for joint, (low, high) in zip(arm.joints, recording.limits_rad, strict=True):
        assert joint.limits_rad is not None
        assert joint.limits_rad[1] - joint.limits_rad[0] == pytest.approx(high - low, abs=0.02)
    assert read_source(out / "source.toml").file.map.unit == "counts"
    assert "encoder = [" in (out / "noise.toml").read_text()

    q_rad = recording.turn(np.zeros(6), range(6))
    write_recording(recording, q_rad, tmp_path / "run.csv")
    with streaming(out / "source.toml") as stream:
        read = np.vstack([stream.read(1.0).q_rad, stream.read(1.0).q_rad])
    assert len(read) == len(q_rad)
    assert np.abs(arm.tip(read) - drawn(6).tip(q_rad)).max() < 15 * noise * arm.core.reach_mm(0)
    plan = load_plan_spec(out / "plan.toml", arm)
    assert plan.encoder_rad == pytest.approx([noise / np.sqrt(0.3 * RATE_HZ)] * 6, rel=0.1)  # the mean of a touch
    assert plan.known_angle_rad == pytest.approx(np.radians(5.0), rel=0.01)


def test_what_a_source_file_says_stays(recording: HomeBuilt, tmp_path: Path) -> None:
    names = ["ms", "-", "a", "b", "c", "d", "e", "f", "g"]
    raw = recording.counts(recording.whole(posture_rad=IN_POSTURE))
    rows = (f"{k * 5},9," + ",".join(f"{each:.0f}" for each in row[:7]) for k, row in enumerate(raw))
    (tmp_path / "run.csv").write_text(",".join(f"x{k}" for k in range(9)) + "\n" + "\n".join(rows) + "\n")
    (tmp_path / "given.toml").write_text(
        f'format = "ulna-source/1"\nurl = "file:run.csv?speed=max&rate={RATE_HZ:g}"\n'
        f'[decode]\nkind = "fields"\nnames = {json.dumps(names)}\ntime = "ms"\n'
        '[map]\nunit = "counts"\ncounts_per_turn = 4096\n[limits]\nspeed = 20\n'
    )
    out = tmp_path / "far" / "found"
    done = run("live", "commission", tmp_path / "given.toml", "--arm", tmp_path / "drawn.toml", "--yes", "-o", out)
    assert done.returncode == 0, done.stderr
    file = read_source(out / "source.toml").file
    assert file.decode is not None
    assert (file.decode.names, file.decode.time, file.limits.speed) == (names, "ms", 20.0)
    assert file.map.channels == ["abcdefg"[k] for k in recording.order]
    with streaming(out / "source.toml") as stream:
        assert stream.read(1.0).q_rad.shape[1] == 6


def test_what_the_command_refuses(recording: HomeBuilt, tmp_path: Path) -> None:
    source, out = f"file:{tmp_path}/run.csv?speed=max&rate={RATE_HZ:g}", tmp_path / "found"
    words = ("live", "commission", source, "-o", out)
    assert_bad_input(run(*words, "--joints", "6"), "expected a terminal", "--yes")
    assert_bad_input(run(*words, "--yes"), "--joints is missing")
    assert_bad_input(run(*words, "--yes", "--joints", "9"), "8 channels", "9 joints")
    assert_bad_input(run(*words, "--yes", "--joints", "5", "--arm", tmp_path / "drawn.toml"), "drawn.toml has 6")
    assert_bad_input(run(*words, "--yes", "--joints", "6", "--signs", "guessed"), "--signs")
    six = ("--yes", "--arm", tmp_path / "drawn.toml")
    assert_bad_input(run(*words, *six, "--zeros", "guessed"), "--zeros", "posture, known or unknown")
    assert_bad_input(run(*words, *six, "--zeros", "posture", "--signs", "unknown"), "--zeros", "signs")
    assert_bad_input(run(*words, *six, "--zeros", "unknown", "--posture", "0,0,0,0,0,0"), "--posture", "Leave one")
    assert_bad_input(run(*words, *six, "--posture", "0,90,0"), "--posture: got 3 angles, expected 6")
    assert_bad_input(run(*words, *six, "--posture", "0,90,up"), "--posture", "'0,90,up'", "commas")
    write_recording(recording, recording.whole()[:3000], tmp_path / "run.csv")
    done = run(*words, "--yes", "--joints", "6")
    assert (done.returncode, done.stdout) == (2, "")
    assert "end of the recording" in done.stderr
    assert "Nothing was written" in done.stderr
    write_recording(recording, recording.whole(ways=[0], skipped=[3]), tmp_path / "run.csv")
    done = run(*words, "--yes", "--joints", "6")
    assert (done.returncode, done.stdout) == (2, "")
    assert "joint 4: never turned" in done.stderr
    assert "Joint 4 is left out." in done.stderr
    assert not out.exists()


def test_without_a_drawing_only_the_first_sign_is_known(recording: HomeBuilt, tmp_path: Path) -> None:
    write_recording(recording, recording.whole(ways=[0]), tmp_path / "run.csv")
    out = tmp_path / "found"
    source = f"file:{tmp_path}/run.csv?speed=max&rate={RATE_HZ:g}"
    done = run("live", "commission", source, "--joints", "6", "--yes", "--counts-per-turn", "4096", "-o", out)
    assert done.returncode == 0, done.stderr
    arm = Arm.load(out / "arm.toml")
    assert [joint.sign for joint in arm.joints] == [1, 0, 0, 0, 0, 0]
    assert "first guess" in (out / "arm.toml").read_text()
    assert max(map(len, done.stdout.splitlines())) <= 80
    again = run("live", "commission", source, "--joints", "6", "--yes", "-o", out)
    assert_bad_input(again, "exists already")


def test_on_a_terminal_it_asks(recording: HomeBuilt, tmp_path: Path) -> None:
    """Each finding is answered by y; the last question is how many counts a turn has where nothing wrapped."""
    ours, theirs = terminals.openpty()
    out = tmp_path / "found"
    source = f"file:{tmp_path}/run.csv?speed=max&rate={RATE_HZ:g}"
    process = subprocess.Popen(
        [sys.executable, "-m", "ulna", "live", "commission", source, "--arm", tmp_path / "drawn.toml", "-o", out],
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        env=os.environ | {"COLUMNS": "80", "TERM": "xterm"},
    )
    os.close(theirs)
    heard, until = "", time.monotonic() + 60
    while process.poll() is None:
        assert time.monotonic() < until, heard
        if select.select([ours], [], [], 0.2)[0]:
            try:
                heard += os.read(ours, 65536).decode()
            except OSError:
                break
            if heard.endswith((": ", "]: ")):
                os.write(ours, b"4096\n" if "Counts per turn" in heard.rsplit("\n", 1)[-1] else b"y\n")
                heard += "\n"
    assert process.wait(timeout=20) == 0, heard
    os.close(ours)
    assert heard.count("Is that so?") == 14
    assert "Bring the arm into this posture" in heard
    assert "Is the unit counts?" in heard
    assert Arm.load(out / "arm.toml").signs.tolist() == recording.signs.tolist()
