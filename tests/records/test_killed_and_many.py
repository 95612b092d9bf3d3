"""Nothing that was said to be done is lost: killed at any moment, and with many who write at once."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from sqlalchemy import func, select
from tests.records.benches import RESULT, ROOT
from tests.records.writing import content

from ulna.records.records import Records
from ulna.records.store import sha256_of
from ulna.records.tables import ENTRY, FILE

TIMES = int(os.environ.get("ULNA_KILLS", "12"))
"""Kills of each act: ULNA_KILLS=200 python -m pytest tests/records -k killed"""
ADDS = int(os.environ.get("ULNA_ADDS", "25"))
"""Of each of the eight that write at once."""
WRITERS = 8


def program(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "tests.records.writing", *map(str, arguments)]


@pytest.fixture
def bench(tmp_path: Path, database: Callable[[], str | None]) -> Records:
    records = Records.init(tmp_path / "bench", database(), by="Jan")
    records.register("P7")
    (tmp_path / "files").mkdir()
    return records


@pytest.mark.slow
@pytest.mark.parametrize("act", ["add", "event", "issue", "rebuild"])
def test_killed_at_any_moment(bench: Records, tmp_path: Path, act: str) -> None:
    bench.add(RESULT, arm="P7")
    done = subprocess.run(
        program("kill", bench.bench.folder, tmp_path / "files", act, TIMES, 7),
        cwd=ROOT, capture_output=True, text=True, timeout=max(280, 4 * TIMES), check=True,
    )  # fmt: skip
    # children that were killed say nothing; what they say of errors would be a fault
    assert done.stderr == ""
    bench.event("P7", "note", "after")  # the next command works
    found = bench.verify()
    assert found.wrong == []
    with bench.bench.reading() as connection:
        kept = set(connection.scalars(select(FILE.c.sha256)))
        texts = " ".join(connection.scalars(select(ENTRY.c.text)))
    first, *said = done.stdout.split()
    for number in [first, *said]:
        if act == "add" or number == first:
            assert sha256_of(content(int(number))) in kept, f"{number} was said to be filed"
        else:
            assert f"{act} {number}" in texts.replace("certificate ", "issue ")
    assert said or act == "rebuild", "no child came so far as to write: nothing was tried"


@pytest.mark.slow
def test_many_write_at_once(bench: Records, tmp_path: Path) -> None:
    writers = [
        subprocess.Popen(
            program("add", bench.bench.folder, tmp_path / "files", 1000 * k, ADDS),
            cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        )
        for k in range(WRITERS)
    ]  # fmt: skip
    for writer in writers:
        _, said = writer.communicate(timeout=max(280, 10 * ADDS))
        assert (writer.returncode, said) == (0, "")
    with bench.bench.reading() as connection:
        assert connection.scalar(select(func.count()).select_from(FILE)) == WRITERS * ADDS
        assert connection.scalar(select(func.max(ENTRY.c.seq))) == WRITERS * ADDS + 1
    assert bench.verify().wrong == []
