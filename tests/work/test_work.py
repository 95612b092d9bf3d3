"""Work that is cut into pieces: the same answer whoever does it, however it is cut, and however often it is begun."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ulna
from ulna.calibration.recalibrations import Recalibrations, job_of, recalibrations
from ulna.ground.errors import UlnaInputError
from ulna.reproduce.ways import readings, trial
from ulna.reproduce.ways.arms import SEVEN, true_arm
from ulna.work.ledger import Ledger
from ulna.work.pieces import Threads, workers_at


def study_and_truth() -> tuple[ulna.Study, ulna.Arm]:
    truth = true_arm(SEVEN)
    return trial.study_of(truth.arm, readings.bars(truth, 3)), truth.arm


def same(one: Recalibrations, other: Recalibrations) -> None:
    np.testing.assert_array_equal(one.parameters, other.parameters)
    np.testing.assert_array_equal(one.u, other.u)
    np.testing.assert_array_equal(one.converged, other.converged)
    assert one.names == other.names


def square(piece: int) -> int:
    time.sleep(0.002 * (piece % 3))
    return piece * piece


def test_threads_do_each_piece_once() -> None:
    for count in (1, 2, 5):
        found = list(Threads(count).each(square, list(range(40))))
        assert sorted(found) == [(k, k * k) for k in range(40)]
    assert list(Threads().each(square, [])) == []


def test_what_the_work_raises_is_raised_and_nothing_more_is_begun() -> None:
    begun: list[int] = []

    def work(piece: int) -> int:
        begun.append(piece)
        if piece == 3:
            raise UlnaInputError("no")
        return piece

    with pytest.raises(UlnaInputError, match="no"):
        list(Threads(2).each(work, list(range(100))))
    assert len(begun) < 10


def test_no_more_pieces_run_at_once_than_there_are_threads() -> None:
    lock, running, most = threading.Lock(), 0, 0

    def work(_: int) -> None:
        nonlocal running, most
        with lock:
            running += 1
            most = max(most, running)
        time.sleep(0.002)
        with lock:
            running -= 1

    list(Threads(3).each(work, list(range(30))))
    assert most == 3


def test_recalibrations_do_not_depend_on_the_cut() -> None:
    study, truth = study_and_truth()
    whole = recalibrations(study, truth, 60, seed=4, piece_runs=60)
    for piece_runs, threads in ((7, 2), (20, 1), (59, 3)):
        same(recalibrations(study, truth, 60, seed=4, piece_runs=piece_runs, workers=Threads(threads)), whole)
    other = recalibrations(study, truth, 60, seed=5)
    assert abs(other.parameters - whole.parameters).max() > 0
    assert whole.converged.all()
    assert whole.names[0] == "joint.1.theta0"
    free = whole.u[0] > 0
    off = (whole.parameters - truth.parameters)[:, free] / whole.u[:, free]
    assert np.mean(abs(off) < 2) == pytest.approx(0.954, abs=0.03)


class Dying:
    """Does some pieces, then is interrupted."""

    def __init__(self, after: int) -> None:
        self.after, self.done = after, 0

    def each(self, work: Callable[[Any], Any], pieces: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        for number, piece in enumerate(pieces):
            if self.done == self.after:
                raise KeyboardInterrupt
            self.done += 1
            yield number, work(piece)


class Counting(Dying):
    def __init__(self) -> None:
        super().__init__(10**9)


def test_interrupted_work_goes_on_where_it_stopped(tmp_path: Path) -> None:
    study, truth = study_and_truth()
    whole = recalibrations(study, truth, 50, seed=1, piece_runs=10)
    job = job_of(study, truth, 50, 1, 10)
    with pytest.raises(KeyboardInterrupt):
        recalibrations(study, truth, 50, 1, workers=Dying(3), ledger=Ledger(tmp_path / "job", job), piece_runs=10)
    (tmp_path / "job" / "piece-1.npz").write_bytes(b"PK\x03\x04 half a file")  # as a full disk might leave it
    told: list[tuple[str, int, int]] = []
    rest = Counting()
    again = recalibrations(
        study,
        truth,
        50,
        1,
        workers=rest,
        ledger=Ledger(tmp_path / "job", job),
        piece_runs=10,
        progress=lambda *report: told.append(report),
    )
    assert rest.done == 3
    assert [done for _, done, _ in told] == [0, 10, 20, 30, 40, 50]
    same(again, whole)
    finished = Counting()
    same(
        recalibrations(study, truth, 50, 1, workers=finished, ledger=Ledger(tmp_path / "job", job), piece_runs=10),
        whole,
    )
    assert finished.done == 0


def test_another_jobs_work_is_not_taken(tmp_path: Path) -> None:
    study, truth = study_and_truth()
    Ledger(tmp_path / "job", job_of(study, truth, 50, 1))
    Ledger(tmp_path / "job", job_of(study, truth, 50, 1))
    with pytest.raises(UlnaInputError, match=r"keeps another job's work; seed is not what is asked now"):
        Ledger(tmp_path / "job", job_of(study, truth, 50, 2))
    moved, _ = study_and_truth()
    moved.readings[0].q_rad[5, 2] += 1e-9
    with pytest.raises(UlnaInputError, match="study_sha256 is not"):
        Ledger(tmp_path / "job", job_of(moved, truth, 50, 1))
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "letter.txt").write_text("dear")
    with pytest.raises(UlnaInputError, match="holds other files"):
        Ledger(tmp_path / "full", job_of(study, truth, 50, 1))
    with pytest.raises(UlnaInputError, match="cannot be used"):
        Ledger(tmp_path / "full" / "letter.txt", job_of(study, truth, 50, 1))


def test_two_who_begin_at_once_keep_one_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    link = os.link

    def late(one: Path, other: Path) -> None:
        monkeypatch.undo()
        other.write_text('{"format": "ulna-job/1", "seed": 2}')
        link(one, other)

    monkeypatch.setattr(os, "link", late)
    with pytest.raises(UlnaInputError, match="keeps another job's work; seed is not what is asked now"):
        Ledger(tmp_path / "job", {"seed": 1})
    assert [path.name for path in (tmp_path / "job").iterdir()] == ["job.json"]

    ledger = Ledger(tmp_path / "job", {"seed": 2})
    save = np.savez

    def both(*arguments: Any, **named: Any) -> None:  # another run of the job keeps the piece while this one does
        monkeypatch.undo()
        ledger.keep(0, {"a": np.zeros(3)})
        save(*arguments, **named)

    monkeypatch.setattr(np, "savez", both)
    ledger.keep(0, {"a": np.zeros(3)})
    kept = ledger.kept(0)
    assert kept is not None
    assert kept["a"].tolist() == [0.0, 0.0, 0.0]
    assert {path.name for path in (tmp_path / "job").iterdir()} == {"job.json", "piece-0.npz"}


def test_noise_must_be_stated() -> None:
    study, truth = study_and_truth()
    study.noise = None
    with pytest.raises(UlnaInputError, match="no noise is stated"):
        recalibrations(study, truth, 10)


def test_a_scheduler_that_does_not_answer_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ulna.work.on_dask.TIMEOUT_S", 0.3)
    expected = pytest.raises(UlnaInputError, match=r"--dask tcp://127.0.0.1:9: no scheduler answers there")
    with expected, workers_at("tcp://127.0.0.1:9"):
        pass
    with workers_at(None) as here:
        assert isinstance(here, Threads)
