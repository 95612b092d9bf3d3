"""`ulna live`: its commands, on a pseudo-terminal's line and on recordings."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import assert_bad_input, run
from tests.live.parts import Pty, pty

from ulna.ground.errors import UlnaInputError
from ulna.live.ending import JOURNAL, nothing_left
from ulna.live.journal import EVENT, SAMPLES, Journal, Reading
from ulna.live.samples import Hello

SOURCE = """\
format = "ulna-source/1"
url = "serial:{path}"
[decode]
kind = "fields"
names = ["ms", "a", "b"]
time = "ms"
[map]
unit = "counts"
counts_per_turn = 4096
"""


@pytest.fixture
def line() -> Iterator[Pty]:
    with pty() as pair:
        yield pair


def started(*words: str | Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "ulna", *map(str, words)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"COLUMNS": "80", "TERM": "dumb"},
    )


def sent(line: Pty, process: subprocess.Popen[str], begin: int = 0, seconds: float = 30.0) -> int:
    """Sends a reading each 10 ms until the process ends; how many."""
    k, until = begin, time.monotonic() + seconds
    while process.poll() is None:
        assert time.monotonic() < until
        line.send(f"{10 * k},{1000 + k},{(4000 + k) % 4096}\n".encode())
        k += 1
        time.sleep(0.01)
    return k


def test_record_and_replay(line: Pty, tmp_path: Path) -> None:
    toml, journal, csv = tmp_path / "source.toml", tmp_path / "run.journal", tmp_path / "run.csv"
    toml.write_text(SOURCE.format(path=line.path))
    process = started("live", "record", toml, "-o", journal, "--seconds", "2")
    sent(line, process)
    out, err = process.communicate(timeout=30)
    assert process.returncode == 0, err
    assert "faults: " in out
    samples = [record.content for record in Reading(journal) if record.kind == SAMPLES]
    raw = np.concatenate([each.raw for each in samples])
    assert len(raw) > 50
    assert set(np.diff(raw[:, 0])) == {1.0}  # nothing lost
    events = [record.content["kind"] for record in Reading(journal) if record.kind == EVENT]
    assert [kind for kind in events if kind != "garbage"] == ["wrap", "end"]

    done = run("live", "replay", journal, "--speed", "max", "--json")
    assert done.returncode == 0, done.stderr
    lines = [json.loads(each) for each in done.stdout.splitlines()]
    assert [each["raw"]["a"] for each in lines if "raw" in each] == raw[:, 0].tolist()
    angles = np.array([each["q_rad"][1] for each in lines if "q_rad" in each])
    assert np.all(np.abs(np.diff(angles)) < 0.01)  # the mapping was kept, the turn counted
    assert [each["fault"]["kind"] for each in lines if "fault" in each] == ["wrap"]
    assert lines[-1]["end"]["samples"] == len(raw)

    done = run("live", "replay", journal, "-o", csv)
    assert done.returncode == 0, done.stderr
    assert csv.read_text().splitlines()[0] == "t_host_s,t_device_s,a,b"
    again = run("live", "replay", csv, "--speed", "max", "--json")
    told = [json.loads(each) for each in again.stdout.splitlines()]
    assert [each["raw"]["b"] for each in told if "raw" in each] == raw[:, 1].tolist()
    assert_bad_input(run("live", "record", toml, "-o", journal), "never overwritten")
    assert_bad_input(run("live", "replay", journal, "-o", csv), "exists already")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_ends_a_recording_whole(line: Pty, tmp_path: Path, number: signal.Signals) -> None:
    journal = tmp_path / "run.journal"
    process = started("live", "record", f"serial:{line.path}?wait=20", "-o", journal)
    begin = time.monotonic()
    k = 0
    while process.poll() is None:
        line.send(f"{k},{2 * k}\n".encode())
        k += 1
        time.sleep(0.01)
        if journal.exists() and journal.stat().st_size > 400:
            process.send_signal(number)
            break
        assert time.monotonic() - begin < 30
    out, err = process.communicate(timeout=20)
    assert process.returncode == 0, err
    assert "samples" in out
    reading = Reading(journal)
    records = list(reading)
    assert reading.cut is None
    assert records[-1].content["text"] == "ended by the user."
    assert sum(len(record.content) for record in records if record.kind == SAMPLES) == records[-1].content["samples"]


def test_watch_in_lines_and_a_pulled_cable(line: Pty) -> None:
    process = started("live", "watch", f"serial:{line.path}?wait=20")
    begin, k = time.monotonic(), 0
    while time.monotonic() - begin < 4:
        line.send(f"{k} {k}\n".encode())
        k += 1
        time.sleep(0.01)
    line.pull()
    out, err = process.communicate(timeout=20)
    assert process.returncode == 0, err
    assert "/s: " in out
    assert "cable was pulled" in out.splitlines()[-1]


def test_guess(line: Pty, tmp_path: Path) -> None:
    toml = tmp_path / "source.toml"
    process = started("live", "guess", f"serial:{line.path}", "--seconds", "2", "-o", toml)
    sent(line, process)
    out, err = process.communicate(timeout=20)
    assert process.returncode == 0, err
    assert "commas between" in out
    assert 'unit = "counts"' in out
    assert "Look at it" in err
    assert toml.read_text().startswith('format = "ulna-source/1"')
    assert 'time_unit = "ms"' in toml.read_text()


def test_guess_of_silence_is_no(line: Pty) -> None:
    done = run("live", "guess", f"serial:{line.path}", "--seconds", "0.3")
    assert done.returncode == 1
    assert "Nothing came" in done.stdout


def test_ports() -> None:
    done = run("live", "ports", "--json")
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert {"serial", "tcp", "file"} <= {each["scheme"] for each in document["kinds"]}
    assert "ports" in run("live", "ports").stdout


def test_what_is_wrong_is_one_sentence(tmp_path: Path) -> None:
    assert_bad_input(run("live", "watch", "serial:/dev/nowhere"), "cannot be opened", "ulna live ports")
    assert_bad_input(run("live", "guess", f"file:{tmp_path}/x.csv"), "brings readings, not bytes")
    assert_bad_input(run("live", "replay", tmp_path / "none.journal"), "no such file")
    assert_bad_input(run("live", "replay", tmp_path / "none.journal", "--speed", "fast"), "speed", "fast")


EMPTY = {
    "names.csv": "t,q1,q2,q3,q4\n",
    "words.csv": "t,q1,q2,q3,q4\nx,y,z,a,b\n",
    "line.csv": "hello\n",
    "bare.csv": "",
    "none.journal": None,
}


@pytest.mark.parametrize("name", EMPTY)
def test_a_source_without_a_reading_is_one_sentence_and_leaves_nothing(result: Path, tmp_path: Path, name: str) -> None:
    file, text = tmp_path / name, EMPTY[name]
    if text is None:
        hello = Hello(("a", "b", "c", "d"), "rad", str(file))
        with Journal.create(file, hello) as journal:
            journal.event({"kind": "end", "text": "ended by the user.", "samples": 0})
    else:
        file.write_text(text)
    out, table = tmp_path / "out.journal", tmp_path / "out.csv"
    toml = tmp_path / "source.toml"
    toml.write_text(f'format = "ulna-source/1"\nurl = "file:{file}"\n[map]\nunit = "rad"\n')
    for words in (
        ["watch", file],
        ["watch", file, "--json"],
        ["replay", file],
        ["replay", file, "-o", table],
        ["record", file, "-o", out],
        ["relay", file, "ws://127.0.0.1:9/"],
        ["measure", result, toml, "--probe", "bent", "-o", table],
        ["commission", toml, "--joints", "4", "--yes", "-o", tmp_path / "arm"],
    ):
        done = run("live", *words)
        assert_bad_input(done, name)
        assert done.stdout == ""
    expected = {"names.csv": "ended without a reading", "words.csv": "5 numbers: 'x,y,z,a,b", "bare.csv": "is empty"}
    assert expected.get(name, "reading") in run("live", "watch", file).stderr
    assert sorted(each.name for each in tmp_path.iterdir()) == sorted([name, "source.toml"])


def test_a_recording_that_ends_before_a_reading_is_none(tmp_path: Path) -> None:
    """The time was over first."""
    done = run("live", "record", "virtual:", "-o", tmp_path / "run.journal", "--seconds", "0")
    assert done.returncode == 2
    assert "run.journal: not written, for no reading came" in done.stderr
    assert not list(tmp_path.iterdir())


def test_touching_without_a_reading_leaves_nothing(root: Path, tmp_path: Path) -> None:
    """Nor does it take away what stood there."""
    (tmp_path / "names.csv").write_text("q1,q2,q3,q4,q5,q6,q7\n")
    source = tmp_path / "source.toml"
    source.write_text(f'format = "ulna-source/1"\nurl = "file:{tmp_path}/names.csv"\n[map]\nunit = "rad"\n')
    arm, plan = root / "examples/platinum/platinum.toml", root / "examples/platinum/plan.toml"
    done = run("live", "touch", arm, plan, source, "-o", tmp_path / "out")
    assert done.returncode == 2
    assert "ended without a reading" in done.stderr
    assert not (tmp_path / "out").exists()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mine.txt").write_text("mine")
    (tmp_path / "out" / JOURNAL).write_text("begun")
    with pytest.raises(UlnaInputError), nothing_left(tmp_path / "out", lambda: False):
        raise UlnaInputError("no reading")
    assert [each.name for each in (tmp_path / "out").iterdir()] == ["mine.txt"]
