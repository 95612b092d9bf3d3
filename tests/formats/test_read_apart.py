"""Files that a process of their own reads: whatever becomes of it is one message, and the next file is read."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from tests.foreign_tables import matlab73
from tests.formats.test_stream import Q, table

from ulna.formats import answering, asking
from ulna.formats.layout import Layout
from ulna.formats.table import read_header, read_table, stream
from ulna.formats.tables import arrays, hdf5, hdf5_apart
from ulna.ground.errors import UlnaInputError

#: a reader that does what a library does with a damaged file
READER = """
import os, signal, sys, time
from ulna.formats.answering import serve

def answer(question, alive):
    yield
    what = question["place"]
    if what == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if what == "leave":
        os._exit(7)
    if what == "hang":
        time.sleep(1000)
    if what == "slow":
        alive.say("alive", reading=60_000_000)
        time.sleep(1)
    if what == "memory":
        bytearray(3 << 30)
    if what == "babble":
        os.write(1, b"what a library prints")
        sys.stdout.write("is no answer")
    alive.say("some", variables=[], inner=["/" + what])

serve(answer)
"""


def numeric(column: str) -> bool:
    return column in Q


@pytest.fixture
def reader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    (tmp_path / "a_reader.py").write_text(READER)
    monkeypatch.syspath_prepend(str(tmp_path))
    apart = asking.Apart("a_reader")
    monkeypatch.setattr(hdf5, "READER", apart)
    yield apart
    apart.close()


@pytest.fixture
def file(tmp_path: Path) -> Path:
    with h5py.File(tmp_path / "h.h5", "w") as made:
        for name in Q:
            made[name] = np.linspace(-1, 1, 5)
    return tmp_path / "h.h5"


def told(path: Path, dataset: str | None = None) -> str:
    try:
        header = read_header(path, "readings", Layout(dataset=dataset))
        read_table(header, numeric, Q)
    except UlnaInputError as error:
        return str(error)
    return ""


@pytest.mark.parametrize(
    ("what", "expected"),
    [
        ("crash", "damaged: its reader was ended by SIGSEGV"),
        ("leave", "damaged: its reader ended with code 0x7"),
        ("hang", "damaged: its reader gave no sign for 1 s and was stopped"),
        ("memory", "its reader needs far more memory than such a file should"),
    ],
)
@pytest.mark.skipif(sys.platform == "win32", reason="no signals and no limit of memory")
def test_whatever_becomes_of_the_reader_is_told(
    what: str, expected: str, reader: asking.Apart, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if what == "memory" and sys.platform != "linux":
        pytest.skip("no limit of memory")
    monkeypatch.setattr(asking, "QUIET_S", 1)
    message = told(file, what)
    assert message.startswith(f"{file}: {expected}")
    assert "expected readings" in message
    assert "heck the copy" in message
    assert "only /babble" in told(file, "babble"), "the next file is read, and what is printed is no answer"


def test_a_reader_that_reads_much_at_once_has_time(
    reader: asking.Apart, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(asking, "QUIET_S", 0.1)
    monkeypatch.setattr(asking, "SLOWEST", 1e6)
    assert "only /slow" in told(file, "slow")


def test_a_reader_that_cannot_begin_blames_no_file(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hdf5, "READER", asking.Apart("no_such_module"))
    assert f"{file}: the process that reads HDF5 ended with code 0x1; expected" in told(file)
    monkeypatch.setattr("multiprocessing.spawn.get_executable", lambda: str(file.parent / "none"))
    assert "cannot be started (No such file" in told(file)


def test_a_library_that_waits_for_ever_is_stopped(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The real one: by a link it opens a pipe in which nobody writes."""
    if not hasattr(os, "mkfifo"):
        pytest.skip("no named pipes")
    os.mkfifo(file.parent / "pipe")
    with h5py.File(file, "a") as made:
        made["other"] = h5py.ExternalLink("pipe", "x")
        made["soft"] = h5py.SoftLink("/other")
    monkeypatch.setattr(asking, "QUIET_S", 1)
    assert "its reader gave no sign for 1 s" in told(file, "soft")
    assert "'other/x' is a link to another file; expected" in told(file, "other/x")
    with h5py.File(file, "a") as made:
        del made["soft"]
    header = read_header(file)
    assert header.origin("other") == "'other' is a link to another file"
    assert len(read_table(header, numeric, Q)) == 5


@pytest.fixture
def groups(tmp_path: Path) -> tuple[Path, bytearray]:
    """A good file as the oldest libraries write it, whose names are in a tree and a heap; its bytes."""
    path = tmp_path / "old.h5"
    with h5py.File(path, "w", libver=("earliest", "v108")) as made:
        for name in Q:
            made[name] = np.linspace(-1, 1, 5)
    assert told(path) == ""
    return path, bytearray(path.read_bytes())


@pytest.mark.skipif(sys.platform == "win32", reason="no signals")
def test_a_library_that_crashes_is_told(groups: tuple[Path, bytearray], file: Path) -> None:
    """The real one: a node of the tree of names (version 1: level at byte 5, first child at 32) is its own child."""
    path, content = groups
    node = content.index(b"TREE")
    content[node + 5] = 1
    content[node + 32 : node + 40] = node.to_bytes(8, "little")
    path.write_bytes(content)
    assert f"{path}: damaged: its reader was ended by SIGSEGV" in told(path)
    assert told(file) == "", "the next file is read"


def test_a_library_that_goes_in_circles_is_stopped(
    groups: tuple[Path, bytearray], file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The real one: the first free block of the heap of names (its offset at byte 16, its data at 24) is followed by
    itself. Some of its versions go round for ever, and some until they have no more room."""
    path, content = groups
    heap = content.index(b"HEAP")
    free, data = (int.from_bytes(content[heap + k : heap + k + 8], "little") for k in (16, 24))
    content[data + free : data + free + 8] = free.to_bytes(8, "little")
    path.write_bytes(content)
    monkeypatch.setattr(asking, "QUIET_S", 2)
    said = told(path)
    assert str(path) in said
    assert "damaged: its reader gave no sign for 2 s and was stopped" in said or "memory allocation failed" in said
    monkeypatch.undo()
    assert told(file) == "", "the next file is read"


def test_sizes_that_no_file_has_are_refused(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with h5py.File(file, "a") as made:
        made.create_dataset("n", data=np.zeros(17 << 20, "i1"), chunks=(1 << 20,), compression="gzip")
    assert file.stat().st_size < 100_000
    with pytest.raises(UlnaInputError, match=r"the values of n would take 14\d MB.*and the file has .* kB; expected"):
        read_table(read_header(file), numeric, ["n"])
    with h5py.File(file, "a") as made:
        del made["n"], made["q1"]
        made.create_dataset("q1", shape=(1 << 30,), dtype="f8", chunks=(1 << 16,), compression="gzip")
    assert "more than the file can hold" in told(file)
    monkeypatch.setattr(arrays, "MOST_COMPRESSED", 1 << 40)
    assert "the values of q1" in told(file).replace("q1, q2, q3", "q1") or "has 1073741824" in told(file)
    with h5py.File(file, "a") as made:
        del made["q1"]
        made["q1"] = np.zeros(1000)
        made["q1"].attrs["MATLAB_class"] = np.bytes_("double")
        made["q1"].attrs["MATLAB_empty"] = np.uint8(1)
    assert "'q1' is an empty array of 1000 dimensions" in told(file)


def test_a_block_is_decompressed_as_a_whole(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with h5py.File(file, "a") as made:
        made.create_dataset("n", data=np.zeros((2, 40 << 20), "i1"), chunks=(2, 40 << 20), compression="gzip")
    monkeypatch.setattr(hdf5_apart, "_BLOCK_BYTES", 1 << 20)
    with h5py.File(file) as made, pytest.raises(answering.RefusedError, match="in blocks of 80 MB; expected blocks of"):
        hdf5_apart._check_blocks(made["n"])


@pytest.mark.parametrize("kind", ["plain", "small blocks", "large blocks", "one block", "turned", "columns"])
def test_streaming_is_reading_whatever_the_order_in_the_file(tmp_path: Path, kind: str) -> None:
    frame = table(511 if kind == "turned" else 20_011)
    path = tmp_path / "h.h5"
    numbers, ids = frame.select(Q).to_numpy(), frame["id"].to_list()
    blocks = {"small blocks": (7, 2), "large blocks": (15_000, 3), "one block": numbers.shape}
    if kind == "turned":
        matlab73(frame, path)
    else:
        with h5py.File(path, "w") as made:
            made["id"] = ids
            if kind == "columns":
                for k, name in enumerate(Q):
                    made[name] = numbers[:, [k]] if k else numbers[:, k]
            else:
                made.create_dataset("q", data=numbers, chunks=blocks.get(kind))
    header = read_header(path)
    assert read_table(header, numeric, [*Q, "id"]).equals(frame)
    pieces = list(stream(header, Q, ["id"], rows=len(frame) // 4))
    assert len(pieces) == 5
    assert np.concatenate([piece.numbers for piece in pieces]).tolist() == numbers.tolist()
    assert [name for piece in pieces for name in piece.texts["id"]] == ids


def test_a_bad_cell_far_in_is_named(tmp_path: Path) -> None:
    values = np.zeros((20_000, 3))
    values[15_000, 1] = np.nan
    with h5py.File(tmp_path / "h.h5", "w") as made:
        made["q"] = values
    with pytest.raises(UlnaInputError, match="row 15001, column 'q2': got 'nan', expected a finite number"):
        list(stream(read_header(tmp_path / "h.h5"), Q, [], rows=4_096))


def test_threads_read_side_by_side(tmp_path: Path) -> None:
    for k in range(4):
        with h5py.File(tmp_path / f"{k}.h5", "w") as made:
            made["q1"] = np.full(30_000, k)
    sums = dict.fromkeys(range(4), 0.0)

    def read(k: int) -> None:
        sums[k] = sum(
            piece.numbers.sum() for piece in stream(read_header(tmp_path / f"{k}.h5"), ["q1"], [], rows=5_000)
        )

    threads = [threading.Thread(target=read, args=(k,)) for k in sums]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sums == {k: 30_000.0 * k for k in range(4)}


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_the_reader_goes_when_its_program_is_killed(file: Path) -> None:
    code = (
        "import sys; from pathlib import Path; from ulna.formats.table import read_header\n"
        "from ulna.formats.tables.hdf5 import READER\n"
        "read_header(Path(sys.argv[1])); print(READER._running._process.pid, flush=True); input()"
    )
    program = subprocess.Popen(
        [sys.executable, "-c", code, str(file)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert program.stdout is not None
    reader = Path("/proc", program.stdout.readline().strip())
    assert b"hdf5_apart" in (reader / "cmdline").read_bytes()
    program.kill()
    program.communicate(timeout=30)
    until = time.monotonic() + 30
    while reader.exists() and b"hdf5_apart" in (reader / "cmdline").read_bytes():
        assert time.monotonic() < until
        time.sleep(0.05)
