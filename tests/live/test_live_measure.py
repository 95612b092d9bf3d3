"""`ulna live measure`: its lines, its table, a serial line, keys in a terminal."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.cli_runs import BENT, assert_bad_input, run
from tests.live.hands import DWELL, NOISE_RAD, TRAVEL, hand, near, source
from tests.live.parts import in_thread, pty

import ulna
from ulna import Arm, UlnaInputError
from ulna.arm.joint import Joint
from ulna.live.features import asked_for


def test_programs_get_lines_of_json(result: Path, tmp_path: Path) -> None:
    file, csv = source(tmp_path, hand(near(4))), tmp_path / "points.csv"
    words = ["live", "measure", result, file, "--probe", "bent", "--still", "--json", "-o", csv]
    done = run(*words, "--feature", "length p1 p3", "--to", "p1")
    assert done.returncode == 0, done.stderr
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    kinds = [next(iter(line)) for line in lines]
    assert set(kinds) == {"note", "tip", "taken", "feature", "end"}
    taken = [line["taken"] for line in lines if "taken" in line]
    assert [each["name"] for each in taken] == ["p1", "p2", "p3", "p4"]
    assert {line["tip"]["distance"]["to"] for line in lines if "distance" in line.get("tip", {})} == {"p1"}
    assert lines[-1]["end"]["points"] == 4
    length = ulna.measure(result, np.array([each["q_rad"] for each in taken]), "bent").length(0, 2)
    named = [line["feature"] for line in lines if line.get("feature", {}).get("name") == "length p1 p3"]
    assert named[0]["length"]["value"] == pytest.approx(length.value_mm)
    assert named[0]["length"]["expanded"] == pytest.approx(2.0 * (length.u_mm or 0.0))
    # the table is one that `ulna measure` reads, and comes to the same
    with pytest.warns(ulna.InputWarning, match="not used: the columns x, y, z"):
        again = ulna.measure(result, csv)
    assert again.table is not None
    assert again.table["id"].to_list() == ["p1", "p2", "p3", "p4"]
    np.testing.assert_allclose(again.table["u_x"].to_list(), [each["x"]["u"] for each in taken], rtol=1e-9)
    assert_bad_input(run(*words), "points.csv: exists already")
    assert run(*words, "--force").returncode == 0


def test_what_was_asked_wrongly_is_one_sentence(result: Path, tmp_path: Path) -> None:
    file = source(tmp_path, hand(near(1)))
    assert_bad_input(run("live", "measure", result, file, "--probe", "bend"), "Did you mean 'bent'?")
    assert_bad_input(run("live", "measure", result, file, "-o", file, "--force"), ".toml")
    csv = tmp_path / "run.csv"
    assert_bad_input(run("live", "measure", result, file, "--probe", "bent", "-o", csv, "--force"), "is an input")
    few = source(tmp_path, hand([near(1)[0][:6]]))
    assert_bad_input(run("live", "measure", result, few, "--probe", "bent"), "6 channels", "7 joints")
    for texts, expected in (
        (["bal"], "Did you mean 'ball'?"),
        (["length p1"], "1 points; expected 2 of a length"),
        (["plane p1 p2"], "expected 3 or more of a plane"),
        (["length p1 x2"], "got 'x2'"),
        (["length p1 p1"], "twice"),
        (["ball", "plane"], "ball and plane"),
        ([""], "got ''"),
    ):
        with pytest.raises(UlnaInputError) as caught:
            asked_for(texts)
        assert expected in str(caught.value)


@pytest.mark.parametrize(("by", "option", "taken"), [("still", (), 3), ("key", (), 0), ("key", ("--still",), 3)])
def test_what_takes_a_touch_is_as_the_source_file_says(
    result: Path, tmp_path: Path, by: str, option: tuple[str, ...], taken: int
) -> None:
    file = source(tmp_path, hand(near(3)))
    file.write_text(file.read_text() + f'[trigger]\nby = "{by}"\n')
    done = run("live", "measure", result, file, "--probe", "bent", "--json", *option)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1])["end"]["points"] == taken


@pytest.mark.parametrize("by", ["button", "key"])
def test_the_arms_button_takes_a_touch(result: Path, tmp_path: Path, by: str) -> None:
    """At the second of three rests, and on the way to the third, where it is refused."""
    q_rad = hand(near(3))
    down = np.zeros(len(q_rad), dtype=int)
    down[DWELL + TRAVEL + 200 :][:20] = down[2 * (DWELL + TRAVEL) - 25 :][:20] = 1
    rows = [",".join(map(repr, row)) + f",{button}" for row, button in zip(q_rad.tolist(), down.tolist(), strict=True)]
    file = source(tmp_path, q_rad)
    (tmp_path / "run.csv").write_text("\n".join(["q1,q2,q3,q4,q5,q6,q7,button", *rows]) + "\n")
    file.write_text(file.read_text() + f'[trigger]\nby = "{by}"\n')
    done = run("live", "measure", result, file, "--probe", "bent", "--json")
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    (point,) = (line["taken"] for line in lines if "taken" in line)
    assert np.abs(np.array(point["q_rad"]) - near(3)[1]).max() < NOISE_RAD
    (refused,) = (line["refused"] for line in lines if "refused" in line)
    assert "hold still" in refused["reason"]


def test_stops_folded_postures_and_temperature_are_told(tmp_path: Path) -> None:
    """A hand leads joint 1 to its stop, then the arm, all its axes parallel, is folded everywhere."""
    joints = (Joint(a_mm=300.0, limits_rad=(-1.0, 1.0)), Joint(a_mm=300.0), Joint())
    Arm("flat", joints, {"bent": BENT}).save(tmp_path / "arm.toml")
    poses = [np.array([0.2, 0.8, 0.1]), np.array([0.995, 0.8, 0.1]), np.array([1.01, 0.8, 0.1])]
    file = source(tmp_path, hand(poses))
    words = ["live", "measure", tmp_path / "arm.toml", file, "--encoder-u", "5e-6", "--temperature", "25"]
    done = run(*words, "--json", "--still")
    assert done.returncode == 0, done.stderr
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    tips = [line["tip"] for line in lines if "tip" in line]
    assert all(any(text.startswith("stretched or folded") for text in tip["warnings"]) for tip in tips)
    near_stop = [any("from its stop" in text or "beyond its limit" in text for text in tip["warnings"]) for tip in tips]
    assert near_stop == [abs(tip["q_rad"][0]) > 1.0 - np.radians(2.0) for tip in tips]
    assert 0.4 < np.mean(near_stop) < 0.8
    # at the stop itself there is no touch
    assert sum("taken" in line for line in lines) == 1
    assert ["joint 1 is at its stop" in line["refused"]["reason"] for line in lines if "refused" in line] == [True] * 2
    assert any("temperature is not used" in line["note"]["text"] for line in lines if "note" in line)
    shown = run(*words).stdout
    assert "; joint 1 is " in shown
    assert "stretched or folded" in shown


def test_from_a_serial_line(result: Path) -> None:
    q_rad = hand(near(2))
    with pty() as line:
        toml = result.parent / "line.toml"
        toml.write_text(
            f'format = "ulna-source/1"\nurl = "serial:{line.path}?wait=30"\n[map]\nunit = "rad"\n'
            '[decode]\nkind = "fields"\ntime = "ms"\nnames = ["ms", "q1", "q2", "q3", "q4", "q5", "q6", "q7"]\n'
        )
        process = _started("live", "measure", result, toml, "--probe", "bent", "--still", "--json")

        def send() -> None:
            for k, row in enumerate(q_rad.tolist()):
                line.send(f"{10 * k},{','.join(map(repr, row))}\n".encode())
                time.sleep(0.005)
            line.pull()

        with in_thread(send):
            out, err = process.communicate(timeout=60)
    assert process.returncode == 0, err
    taken = [json.loads(each)["taken"] for each in out.splitlines() if each.startswith('{"taken"')]
    assert [each["name"] for each in taken] == ["p1", "p2"]
    assert np.abs(np.array([each["q_rad"] for each in taken]) - near(2)).max() < NOISE_RAD


def _started(*words: str | Path, **how: Any) -> subprocess.Popen[str]:
    how = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True} | how
    return subprocess.Popen([sys.executable, "-m", "ulna", *map(str, words)], env=os.environ | {"TERM": "xterm"}, **how)


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals are POSIX's")
def test_keys_in_a_terminal(result: Path, tmp_path: Path) -> None:
    file, csv = source(tmp_path, hand(near(1), dwell=6000), speed="1"), tmp_path / "points.csv"
    ours, theirs = os.openpty()
    words = ("live", "measure", result, file, "--probe", "bent", "-o", csv)
    process = _started(*words, stdin=theirs, stdout=theirs, stderr=theirs, text=False)
    os.close(theirs)
    shown = b""

    def until(*texts: str) -> None:
        nonlocal shown
        end = time.monotonic() + 40
        while not any(text.encode() in shown for text in texts):
            assert time.monotonic() < end, shown[-2000:].decode(errors="replace")
            shown += os.read(ours, 1 << 16)

    try:
        until("· still")
        for name in ("p1", "p2"):
            os.write(ours, b" ")
            until(f"{name} taken")
        for keys, answer in ((b"k", "f1 is a length"), (b"u", " taken back")):
            os.write(ours, keys)
            until(answer)
        os.write(ours, b"nq")
        until("faults: ")
        until(" points.")
        assert process.wait(timeout=20) == 0
    finally:
        process.kill()
        process.wait(timeout=20)
        os.close(ours)
    rows = csv.read_text().splitlines()
    assert rows[1].startswith("p1,bent,")
    assert f"{len(rows) - 1} points." in shown.decode(errors="replace")
