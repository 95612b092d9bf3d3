"""A worker that is watched: what dies, hangs or swallows memory is recorded, and the worker made anew."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from fuzzing.doors.registry import DOORS
from fuzzing.judging import BYTES

ROOT = Path(__file__).resolve().parents[1]
WALL = 60.0
"""Seconds by the clock, for what sleeps; else the seconds of computing count: the machine may be busy."""
_TICK = os.sysconf("SC_CLK_TCK")
_PAGE = os.sysconf("SC_PAGE_SIZE")


class Worker:
    """A process that is given inputs by name."""

    def __init__(self, room: Path, seed: int) -> None:
        self._room, self._seed = room, seed
        self._process: subprocess.Popen[str] | None = None
        self._folder: Path | None = None

    def put(self, door: str, number: int) -> str | None:
        """What is wrong with how this input ended; None where nothing is."""
        if self._process is None:
            self._start()
        assert self._process is not None
        assert self._process.stdin is not None
        self._process.stdin.write(f"{door} {number}\n")
        self._process.stdin.flush()
        most = DOORS[door].seconds
        began, seconds, memory = time.monotonic(), *self._used()
        while True:
            try:
                said = self._said.get(timeout=0.2)
            except queue.Empty:
                now, used = self._used()
                if now - seconds > most or time.monotonic() - began > WALL + most:
                    self.close()
                    return f"hangs: {time.monotonic() - began:.0f} s by the clock"
                if used - memory > BYTES:
                    self.close()
                    return f"took {(used - memory) >> 20} MB more"
                continue
            if said is None:
                code = self._process.wait()
                self.close()
                return f"killed by {signal.Signals(-code).name}" if code < 0 else f"the process ended with {code}"
            if "found" in said:
                found: str | None = said["found"]
                if found is not None and found.startswith("took"):
                    self.close()  # what it took is not given back
                return found

    def _start(self) -> None:
        self._folder = Path(tempfile.mkdtemp(prefix="fuzzing-"))
        room = shutil.copytree(self._room, self._folder / "room")
        (self._folder / "aside").mkdir()
        command = [sys.executable, "-m", "fuzzing.worker", "--room", room, "--aside", self._folder / "aside"]
        self._process = subprocess.Popen(
            [*map(str, command), "--seed", str(self._seed)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            cwd=ROOT,
            env=os.environ | ENVIRONMENT,
        )
        self._said: queue.Queue[Any] = queue.Queue()
        self._listener = threading.Thread(target=self._listen, args=(self._process, self._said), daemon=True)
        self._listener.start()
        # loading takes its own time, and is nobody's input
        self._process.stdin.write("options 0\n")  # type: ignore[union-attr]
        self._process.stdin.flush()  # type: ignore[union-attr]
        while (said := self._said.get(timeout=120)) is not None and "found" not in said:
            pass

    @staticmethod
    def _listen(process: subprocess.Popen[str], said: queue.Queue[Any]) -> None:
        for line in process.stdout or ():
            said.put(json.loads(line))
        said.put(None)

    def _used(self) -> tuple[float, int]:
        """Seconds of computing and bytes of memory of the process until now."""
        assert self._process is not None
        try:
            fields = Path(f"/proc/{self._process.pid}/stat").read_text().rpartition(")")[2].split()
        except OSError:
            return 0.0, 0
        return (int(fields[11]) + int(fields[12])) / _TICK, int(fields[21]) * _PAGE

    def close(self) -> None:
        """Ends it, and takes away what it had."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._listener.join()
            for stream in (self._process.stdin, self._process.stdout):
                with contextlib.suppress(OSError):
                    stream.close()  # type: ignore[union-attr]
            self._process = None
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)
            self._folder = None


ENVIRONMENT = {
    "PYTHONPATH": str(ROOT / "python"),
    "COLUMNS": "80",
    "TERM": "dumb",
    "MPLBACKEND": "Agg",
    "PYDANTIC_DISABLE_PLUGINS": "__all__",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "RAYON_NUM_THREADS": "1",
    "POLARS_MAX_THREADS": "1",
}


def spread(shares: Mapping[str, int], first: int, inputs: int | None) -> Iterator[tuple[str, int]]:
    """Inputs of each door in turn, as many at a time as is its share; without end where their number is not said."""
    numbers = dict.fromkeys(shares, first)
    ends = float("inf") if inputs is None else first + inputs
    while any(number < ends for number in numbers.values()):
        for door, share in shares.items():
            upto = int(min(numbers[door] + share, ends))
            yield from ((door, k) for k in range(numbers[door], upto))
            numbers[door] = upto
