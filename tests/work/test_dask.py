"""A real cluster of two workers on this machine, of which one is killed midway."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from distributed import Client, LocalCluster
from tests.cli_runs import assert_bad_input, run, strict_json
from tests.work.test_work import same, study_and_truth

from ulna.calibration.recalibrations import recalibrations
from ulna.work.pieces import workers_at

pytestmark = [
    pytest.mark.slow,
    # a worker that is killed on purpose leaves its connection open
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0", silence_logs=50
    ) as made:
        yield made


def slow_pid(piece: int) -> tuple[int, int]:
    time.sleep(0.05)
    return piece, os.getpid()


def test_the_numbers_are_those_of_threads(cluster) -> None:
    study, truth = study_and_truth()
    here = recalibrations(study, truth, 120, seed=2, piece_runs=20)
    told: list[tuple[str, int, int]] = []
    with workers_at(cluster.scheduler_address) as workers:
        there = recalibrations(
            study, truth, 120, seed=2, workers=workers, piece_runs=10, progress=lambda *report: told.append(report)
        )
    same(there, here)
    assert told[-1] == ("calibrations", 120, 120)


def test_a_worker_that_dies_loses_nothing(cluster) -> None:
    """Killed while pieces are on their way: every piece comes back once, done by those who live."""
    with Client(cluster.scheduler_address, set_as_default=False) as client:
        pids = list(client.run(os.getpid).values())
    assert len(set(pids)) == 2
    killed = threading.Event()

    def kill() -> None:
        time.sleep(0.6)
        os.kill(pids[0], signal.SIGKILL)
        killed.set()

    threading.Thread(target=kill, daemon=True).start()
    with workers_at(cluster.scheduler_address) as workers:
        found = list(workers.each(slow_pid, list(range(60))))
    assert killed.is_set()
    assert sorted(number for number, _ in found) == list(range(60))
    assert all(number == piece for number, (piece, _) in found)
    by = {pid for _, (_, pid) in found}
    assert pids[1] in by
    assert len(by) >= 2
    study, truth = study_and_truth()
    with workers_at(cluster.scheduler_address) as workers:
        after = recalibrations(study, truth, 40, seed=3, workers=workers, piece_runs=10)
    same(after, recalibrations(study, truth, 40, seed=3))
    assert np.isfinite(after.parameters).all()


def test_a_folder_of_studies_on_a_cluster(cluster, tmp_path, root) -> None:
    for name in ("one", "two"):
        (tmp_path / "arms" / name).mkdir(parents=True)
        for file in ("study.toml", "platinum.toml", "bars.csv"):
            (tmp_path / "arms" / name / file).write_bytes((root / "examples" / "platinum" / file).read_bytes())
    here = run("batch", tmp_path / "arms", "-o", tmp_path / "here", "--json")
    there = run("batch", tmp_path / "arms", "-o", tmp_path / "there", "--json", "--dask", cluster.scheduler_address)
    assert (here.returncode, there.returncode) == (0, 0), there.stderr
    assert here.stdout == there.stdout
    for name in ("one", "two"):
        one, other = (tmp_path / where / name / "study" / "arm.toml" for where in ("here", "there"))
        assert one.read_bytes() == other.read_bytes()


@pytest.mark.long
def test_a_plan_and_whole_calibrations_redrawn_on_a_cluster(cluster, tmp_path, root) -> None:
    """The same figures as from threads; finished work is kept, and the same command goes on from it."""
    examples = root / "examples" / "platinum"
    (tmp_path / "plan.toml").write_text(
        (examples / "plan.toml").read_text().replace("[plan]", "[plan]\ncandidates = 8000\ntrials = 60")
    )
    ask = ("plan", examples / "platinum.toml", tmp_path / "plan.toml", "--json")
    here = run(*ask)
    there = run(*ask, "--dask", cluster.scheduler_address, "--keep", tmp_path / "trial")
    assert (here.returncode, there.returncode) == (0, 0), there.stderr
    mine, theirs = strict_json(here.stdout), strict_json(there.stdout)
    for document in (mine, theirs):
        del document["seconds"]
    assert mine == theirs
    assert len(list((tmp_path / "trial").glob("piece-*.npz"))) == 7  # 50 and 10; five times 12

    assert run("calibrate", examples / "study.toml", "-o", tmp_path / "out").returncode == 0
    (tmp_path / "length.csv").write_bytes((examples / "length.csv").read_bytes())
    (tmp_path / "length.toml").write_text("digits = 1\n" + (examples / "length.toml").read_text())
    ask = ("uncertainty", tmp_path / "out", tmp_path / "length.toml", "--json", "--study", examples / "study.toml")
    ask = (*ask, "--trials", "1200")
    here = run(*ask)
    there = run(*ask, "--dask", cluster.scheduler_address, "--keep", tmp_path / "kept")
    assert (here.returncode, there.returncode) == (0, 0), there.stderr
    assert here.stdout == there.stdout
    assert len(list((tmp_path / "kept").glob("piece-*.npz"))) == 3
    again = run(*ask, "--keep", tmp_path / "kept")
    assert again.stdout == here.stdout
    other = run(*ask, "--keep", tmp_path / "kept", "--seed", "1")
    assert_bad_input(other, "kept", "keeps another job's work", "seed")
    assert_bad_input(run(*ask[:4], "--keep", tmp_path / "kept"), "finished calibrations", "--study")
