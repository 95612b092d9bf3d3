"""One input through the public door, in this process, and what is wrong with how it ended."""

from __future__ import annotations

import contextlib
import io
import os
import re
import resource
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

from typer.main import get_command

from fuzzing.room import Room, inside
from fuzzing.trial import Trial

BYTES = 1 << 30
ENDINGS = (0, 1, 2)
"""Done; done, and the answer is no; bad input."""
#: words of libraries and of Python, which no message for people has
FOREIGN = re.compile(
    r"Traceback|panicked|RUST_BACKTRACE|polars|pydantic|pyarrow|numpy|openpyxl|calamine|h5py|lxml|HDF5-DIAG|tomllib|"
    r"site-packages|Warning:|object at 0x|NoneType|ndarray|dtype|<class|Input should|Value error|Errno|"
    r"UnicodeEncodeError|astype|broadcast|unsupported operand|literal_error|"
    r"list index|out of bounds for axis|has no attribute|takes \d+ positional"
)
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")
LONGEST = 100_000
"""Characters on stderr."""


@contextlib.contextmanager
def _captured(folder: Path) -> Iterator[dict[str, str]]:
    """What the process says, by itself or by a library in C."""
    said: dict[str, str] = {}
    places = {"stdout": folder / "stdout", "stderr": folder / "stderr"}
    kept = {}
    before = {"stdout": sys.stdout, "stderr": sys.stderr}
    for number, name in ((1, "stdout"), (2, "stderr")):
        getattr(sys, name).flush()
        kept[number] = os.dup(number)
        with places[name].open("wb") as file:
            os.dup2(file.fileno(), number)
    sys.stdout = io.TextIOWrapper(io.FileIO(1, "w", closefd=False), encoding="utf-8", errors="strict")
    sys.stderr = io.TextIOWrapper(io.FileIO(2, "w", closefd=False), encoding="utf-8", errors="backslashreplace")
    try:
        yield said
    finally:
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(Exception):
                stream.flush()
        sys.stdout, sys.stderr = before["stdout"], before["stderr"]
        for number, old in kept.items():
            os.dup2(old, number)
            os.close(old)
        for name, path in places.items():
            said[name] = path.read_bytes().decode("utf-8", "backslashreplace")


@cache
def _command() -> Callable[..., object]:
    """The program, its commands and options made once: that took half of an input's time."""
    from ulna.cli import app

    return get_command(app)


def judge(
    trial: Trial, room: Room, aside: Path, most_seconds: float = 10.0, endings: tuple[int, ...] = ENDINGS
) -> str | None:
    """What is wrong with how Ulna takes an input, in one line; None where nothing is."""
    command = _command()
    room.lay(trial.files)
    memory, began = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    code: object = 0
    escaped = ""
    try:
        with inside(room.folder), _captured(aside) as said:
            try:
                command(trial.arguments, prog_name="ulna")
            except SystemExit as end:
                code = 0 if end.code is None else end.code
            except BaseException as error:
                if isinstance(error, KeyboardInterrupt):
                    raise
                escaped = "".join(traceback.format_exception_only(error)).strip()[:300]
                frames = traceback.extract_tb(error.__traceback__)
                escaped += f" at {Path(frames[-1].filename).name}:{frames[-1].lineno}"
    finally:
        room.clear()
    seconds = time.process_time() - began
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - memory) * 1024
    if escaped:
        return f"escaped: {escaped}"
    return _of(code, endings, said["stdout"], said["stderr"]) or _of_size(seconds, most_seconds, grown)


def _of(code: object, endings: tuple[int, ...], out: str, err: str) -> str | None:
    last = " | ".join(err.strip().splitlines())[-300:]
    if code not in endings:
        return f"exit {code}: {last}"
    if found := FOREIGN.search(err):
        return f"another's words ({found[0]!r}): {last}"
    if code == 2 and not re.search(r"^(error: |Error: |Usage: )", err, re.MULTILINE):
        return f"exit 2 without a message: {last}"
    if found := CONTROL.search(err.replace("\r\n", "\n")):
        return f"control character {found[0]!r} on stderr: {last!r}"
    if len(err) > LONGEST:
        return f"{len(err)} characters on stderr"
    if found := re.search(r"(?<![\w'\"<-])(nan|-?inf)(?![\w'\">])", out):
        at = out[max(0, found.start() - 60) : found.end() + 20]
        return f"{found[0]} in what is printed: {at!r}"
    return None


def _of_size(seconds: float, most_seconds: float, grown: int) -> str | None:
    if seconds > most_seconds:
        return f"took {seconds:.0f} s"
    if grown > BYTES:
        return f"took {grown >> 20} MB more"
    return None
