"""`ulna live touch`, as a program that steers it sees it: over a real socket, killed, gone on with, what it leaves."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.live.guided_hand import Hand, off_its_drawing, platinum_plan

import ulna
from ulna.live.ending import JOURNAL, touches_in
from ulna.live.journal import TOUCH, Reading

SOURCE = """\
format = "ulna-source/1"
url = "tcp://127.0.0.1:{port}"
[decode]
kind = "fields"
names = ["t", "q1", "q2", "q3", "q4", "q5", "q6", "q7"]
time = "t"
time_unit = "s"
[map]
unit = "rad"
[still]
seconds = 0.2
spread = 0.05
drift = 0.03
[trigger]
by = "still"
"""
EXAMPLE = Path("examples/platinum").resolve()


@dataclass
class Played:
    """A run of the command, and the hand at its other end."""

    process: subprocess.Popen[str]
    hand: Hand
    link: socket.socket
    sending: threading.Thread | None = None

    def lines(self) -> Iterator[dict[str, Any]]:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            yield json.loads(line)

    def follow(self, known: dict[str, Any]) -> None:
        """Does what is suggested, in the time that it takes."""
        if self.sending is not None:
            self.sending.join()
        following = known["next"]
        suggestion = SimpleNamespace(
            here=following["here"],
            stand=SimpleNamespace(points_mm=np.array(following["places_mm"])),
            feature=["A", "B"].index(following["feature"]),
            q_rad=np.array(following["q_rad"]),
        )
        self.hand.follow(suggestion)  # type: ignore[arg-type]
        self.sending = threading.Thread(target=self.send, daemon=True)
        self.sending.start()

    def send(self) -> None:
        while self.hand.samples:
            piece = self.hand.samples.popleft()
            rows = zip(piece.t_host_s.tolist(), piece.raw.tolist(), strict=True)
            text = "".join(f"{t:.6f} " + " ".join(f"{q:.9f}" for q in each) + "\n" for t, each in rows)
            try:
                self.link.sendall(text.encode())
            except OSError:
                return  # the command was killed
            time.sleep(len(piece) / self.hand.rate_hz)

    def say(self, word: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(word + "\n")
        self.process.stdin.flush()


@contextmanager
def played(folder: Path, hand: Hand, *options: str, plan: str = "plan.toml") -> Iterator[Played]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        source = folder / "source.toml"
        source.write_text(SOURCE.format(port=server.getsockname()[1]), encoding="utf-8")
        arguments = [str(EXAMPLE / "platinum.toml"), str(EXAMPLE / plan), str(source), "-o", str(folder / "out")]
        process = subprocess.Popen(
            [sys.executable, "-m", "ulna", "live", "touch", *arguments, "--json", "--goal", "0.04", "--length", "500",
             *options],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        server.settimeout(60.0)
        link, _ = server.accept()
        run = Played(process, hand, link)
        hand.q_rad = hand.travel_rad.mean(axis=1)
        hand.hold(0.05)
        run.send()
        try:
            yield run
        finally:
            process.kill()
            process.communicate()
            link.close()
            if run.sending is not None:
                run.sending.join(timeout=10.0)


def hand_of(seed: int) -> Hand:
    arm, spec = platinum_plan()
    rng = np.random.default_rng(seed)
    assert spec.travel_rad is not None
    truth = off_its_drawing(arm, spec.hold, rng)
    return Hand(truth, spec, spec.travel_rad, rng, rate_hz=200.0, dwell_s=0.4, move_s=1.0)


@pytest.mark.timeout(300)
def test_a_program_follows_the_guide_is_killed_goes_on_and_has_an_arm(tmp_path: Path) -> None:
    hand = hand_of(11)
    with played(tmp_path, hand) as run:
        for line in run.lines():
            if "known" in line:
                if line["known"]["touches"] >= 4:
                    run.process.kill()
                    break
                run.follow(line["known"])
    kept = touches_in(tmp_path / "out" / JOURNAL)
    assert [touch.number for touch in kept] == [1, 2, 3, 4]
    assert not (tmp_path / "out" / "study.toml").exists()

    with played(tmp_path, hand) as run:
        run.say("moved")  # the bar is put elsewhere, perhaps after one more touch where it was
        first = None
        for line in run.lines():
            if "known" in line:
                known = line["known"]
                first = known if first is None else first
                if known["touches"] >= 16 or (known["touches"] > 12 and known["u_mm"] < 0.020):
                    run.say("end")
                    break
                run.follow(known)
        assert first is not None
        assert first["touches"] == 4
        out, err = run.process.communicate(timeout=60.0)
    assert run.process.returncode == 0, (out, err)
    assert "going on with 4 touches" in err
    assert "Place " not in err or "the study does without touch" in err
    result = ulna.Result.load(tmp_path / "out" / "result")
    q_rad = hand.travel_rad[:, 0] + np.random.default_rng(0).random((200, 7)) * np.ptp(hand.travel_rad, axis=1)
    found, true = (arm.core.tip(q_rad, 0) for arm in (result.arm, hand.truth))
    apart = [np.linalg.norm(each[1::2] - each[::2], axis=1) for each in (found, true)]
    assert np.sqrt(((apart[0] - apart[1]) ** 2).mean()) < 0.1


@pytest.mark.timeout(300)
def test_of_a_study_and_with_places_held_out_it_ends_by_itself_and_says_how_good_it_is(tmp_path: Path) -> None:
    with played(tmp_path, hand_of(13), "--touches", "13", "--held-out", "2", plan="study.toml") as run:
        known: list[dict[str, Any]] = []
        last: dict[str, Any] = {}
        for line in run.lines():
            last = line
            if "known" in line:
                known.append(line["known"])
                run.follow(line["known"])
        out, err = run.process.communicate(timeout=60.0)
    assert run.process.returncode == 0, (out, err)
    assert "its 202 readings are not taken into the session" in err
    progress = [each["held_out"]["done"] for each in known if each["held_out"] is not None]
    assert progress[0] == 0
    assert progress[-1] == 2
    assert {each["held_out"]["places"] for each in known if each["held_out"] is not None} == {2}
    assert known[-1]["touches"] <= 13  # what is held out is not counted
    found = last["held_out"]
    assert found["places"] == 2
    study = tmp_path / "out" / "study.toml"
    judged = ulna.evaluate(tmp_path / "out" / "result" / "result.json", ulna.Study.load(study, rows="check"))
    assert found["overall"] == pytest.approx(dict(judged.overall))
    assert found["expected_length_error_rms_mm"] < 0.1
    assert found["overall"]["length_error_rms_mm"] < 0.2 < found["before"]["length_error_rms_mm"]


FULL = """
import resource, signal, sys
import numpy as np
from ulna.ground.errors import UlnaInputError
from ulna.live.journal import Journal
from ulna.live.samples import Hello, Samples
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
journal = Journal.create(sys.argv[1], Hello(("q1",), "rad", "a test"))
noise = np.random.default_rng(0).random((500, 1))
try:
    for k in range(50):
        journal.samples(Samples(np.arange(500.0), None, noise))
        journal.touch({"number": k})
except UlnaInputError as error:
    print(k, error)
try:
    journal.close()
except UlnaInputError:
    print("told again")
"""


def test_a_disk_that_is_full_is_told_and_what_was_acknowledged_is_there(tmp_path: Path) -> None:
    path = tmp_path / "full.journal"
    done = subprocess.run([sys.executable, "-c", FULL, str(path)], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    told = done.stdout.splitlines()[0]
    assert str(path) in told
    acknowledged = int(told.split()[0])
    assert acknowledged > 0
    reading = Reading(path)
    assert sum(record.kind == TOUCH for record in reading) >= acknowledged
    assert reading.cut is not None


@pytest.mark.timeout(120)
def test_words_that_are_none_and_touches_that_are_not_there_are_told(tmp_path: Path) -> None:
    with played(tmp_path, hand_of(12)) as run:
        for word in ("tuoch", "withdraw 7 slipped", "withdraw x", "touch", "end"):
            run.say(word)
        out, err = run.process.communicate(timeout=60.0)
    assert run.process.returncode == 0
    assert "'tuoch' is no word here; expected one of touch, moved, withdraw, hold-out, trust, end." in err
    assert "touch 7: there is none" in err
    assert "withdraw: got 'x'" in err
    assert any("refused" in json.loads(line) for line in out.splitlines())
    assert "too few for a fit: nothing else was written" in err
    assert [path.name for path in (tmp_path / "out").iterdir()] == [JOURNAL]
