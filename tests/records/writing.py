"""Writers that are killed, and writers beside each other: programs of their own, so that a kill ends nothing else.

python -m tests.records.writing add BENCH FOLDER FIRST COUNT      prints the number of each file that is filed
python -m tests.records.writing kill BENCH FOLDER ACT TIMES SEED  kills children in the middle of an act
"""

from __future__ import annotations

import os
import random
import signal
import sys
import time
from pathlib import Path

from ulna.records.bench import Bench
from ulna.records.filing import Filing, file_all
from ulna.records.issuing import Asked, issue
from ulna.records.rebuild import rebuild
from ulna.records.registering import happened

LABORATORY = Path(__file__).resolve().parents[2] / "examples" / "platinum" / "laboratory.toml"


def content(number: int) -> bytes:
    """Of a file, of its own."""
    return f"file {number}\n".encode() * 50


def said(number: int) -> None:
    """In one write, which no kill halves."""
    os.write(1, f"{number}\n".encode())


def add(folder: Path, files: Path, first: int, count: int) -> None:
    """One entry each; a line for each that is there."""
    bench = Bench.open(folder, f"writer {first}")
    for number in range(first, first + count):
        path = files / f"{number}.txt"
        path.write_bytes(content(number))
        file_all(bench, [Filing(path, "P7")])
        said(number)


def events(folder: Path, first: int) -> None:
    """Two entries in one write each."""
    bench = Bench.open(folder, "writer")
    for number in range(first, first + 1000):
        happened(bench, "P7", "quarantine" if number % 2 else "release", f"event {number}")
        said(number)


def issues(folder: Path, first: int) -> None:
    """Certificates of the last calibration."""
    bench = Bench.open(folder, "writer")
    for number in range(first, first + 1000):
        issue(bench, Asked("P7", LABORATORY, number=f"certificate {number}", form="dcc"))
        said(number)


def rebuilds(folder: Path, first: int) -> None:
    """The whole index anew, again and again."""
    bench = Bench(folder, "writer")
    for _ in range(1000):
        rebuild(bench)


def kill(folder: Path, files: Path, act: str, times: int, seed: int) -> None:
    """Each child is killed somewhere in its first moments; what it said before is true."""
    rng = random.Random(seed)
    acts = {"add": lambda first: add(folder, files, first, 1000), "event": lambda first: events(folder, first)}
    acts["issue"] = lambda first: issues(folder, first)
    acts["rebuild"] = lambda first: rebuilds(folder, first)
    add(folder, files, 500, 1)  # what is loaded on the way is loaded now
    if act == "issue":
        issue(Bench.open(folder, "writer"), Asked("P7", LABORATORY, number="first", form="dcc"))
    for k in range(times):
        child = os.fork()
        if child == 0:
            acts[act](1000 * (k + 1))
            os._exit(0)
        time.sleep(rng.uniform(0.0, 0.8))
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


if __name__ == "__main__":
    command, bench_folder, file_folder, *rest = sys.argv[1:]
    if command == "add":
        add(Path(bench_folder), Path(file_folder), int(rest[0]), int(rest[1]))
    else:
        kill(Path(bench_folder), Path(file_folder), rest[0], int(rest[1]), int(rest[2]))
