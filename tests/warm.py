"""Runs of the program without the second that its imports take: a process that has imported them forks for each run.

The child does what `python -m ulna` does, with arguments, environment and folder of its own; it differs from a fresh
process in that what it imports is there already. What Python itself reads of the environment when it starts, and what
asks how long a start takes or what is imported, needs a fresh one: `needs_fresh`.
"""

from __future__ import annotations

import atexit
import gc
import importlib
import json
import os
import pkgutil
import runpy
import signal
import socket
import subprocess
import sys
import threading
import traceback
from collections.abc import Mapping, Sequence
from pathlib import Path

BEGUN = dict(os.environ)
OF_PYTHON = ("PYTHON", "LANG", "LC_", "TZ", "MALLOC", "OPENBLAS", "OMP_", "POLARS", "RAYON", "LD_")
"""How names begin of what a process reads once, when it starts."""
IMPORTED = (
    *("numpy", "polars", "pydantic", "typer", "typer.rich_utils", "rich.console", "rich.table", "rich.progress"),
    *("rich.live", "jinja2", "markupsafe", "openpyxl", "python_calamine", "lxml.etree", "tomllib", "lazy_loader"),
    *("sqlalchemy", "sqlalchemy.dialects.sqlite", "alembic.command", "plotly.offline", "ulna"),
)


def needs_fresh(environment: Mapping[str, str]) -> bool:
    """Whether a run with these variables, beside those of this process, is asked of a fresh process."""
    own = {name for name in {*environment, *BEGUN} if environment.get(name) != BEGUN.get(name)}
    return any(name.startswith(OF_PYTHON) for name in own)


class Warm:
    """The process that forks, started at the first run."""

    def __init__(self) -> None:
        self.busy = threading.Lock()
        self._here, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        command = [sys.executable, "-m", "tests.warm", str(there.fileno())]
        nothing, root = subprocess.DEVNULL, Path(__file__).resolve().parents[1]
        self._process = subprocess.Popen(command, stdin=nothing, stdout=nothing, pass_fds=[there.fileno()], cwd=root)
        there.close()
        atexit.register(self._close)

    def run(
        self, arguments: Sequence[str], environment: Mapping[str, str], timeout_s: float
    ) -> subprocess.CompletedProcess[str]:
        """As `subprocess.run` of `python -m ulna`, its output as text."""
        out, err = os.pipe(), os.pipe()
        asked = json.dumps({"arguments": list(arguments), "environment": dict(environment), "folder": str(Path.cwd())})
        socket.send_fds(self._here, [asked.encode("utf-8", "surrogateescape")], [out[1], err[1]])
        os.close(out[1])
        os.close(err[1])
        child = int(self._here.recv(64))
        said = [b"", b""]
        readers = [threading.Thread(target=_read, args=(said, k, each[0])) for k, each in enumerate((out, err))]
        for reader in readers:
            reader.start()
        self._here.settimeout(timeout_s)
        try:
            status = int(self._here.recv(64))
        except TimeoutError:
            os.kill(child, signal.SIGKILL)
            self._here.settimeout(None)
            self._here.recv(64)
            raise subprocess.TimeoutExpired(list(arguments), timeout_s, *said) from None
        finally:
            for reader in readers:
                reader.join()
        return subprocess.CompletedProcess(list(arguments), status, *(each.decode() for each in said))

    def _close(self) -> None:
        self._here.close()
        self._process.wait(timeout=20)


def _read(said: list[bytes], k: int, descriptor: int) -> None:
    with open(descriptor, "rb") as stream:
        said[k] = stream.read()


# ------------------------------------------------------------ the process itself


def _main(descriptor: int) -> None:
    for name in (*IMPORTED, *_own()):
        importlib.import_module(name)
    gc.freeze()  # what is there is not looked through again in each child
    there = socket.socket(fileno=descriptor)
    while True:
        asked, descriptors, _, _ = socket.recv_fds(there, 1 << 20, 2)
        if not asked:
            return
        child = os.fork()
        if not child:
            there.close()
            _child(json.loads(asked.decode("utf-8", "surrogateescape")), descriptors)
        for each in descriptors:
            os.close(each)
        there.send(str(child).encode())
        there.send(str(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])).encode())


def _own() -> list[str]:
    """All modules of Ulna; what needs an extra loads it when it is asked for."""
    import ulna

    found = pkgutil.walk_packages(ulna.__path__, "ulna.")
    return [
        each.name for each in found if not each.name.endswith(("__main__", "_core")) and ".migrations." not in each.name
    ]


def _child(asked: dict[str, object], descriptors: Sequence[int]) -> None:
    code = 1
    try:
        os.dup2(descriptors[0], 1)
        os.dup2(descriptors[1], 2)
        for each in descriptors:
            os.close(each)
        os.chdir(str(asked["folder"]))
        os.environ.clear()
        os.environ.update(asked["environment"])  # type: ignore[call-overload]
        sys.argv = ["ulna", *asked["arguments"]]  # type: ignore[misc]
        try:
            runpy.run_module("ulna", run_name="__main__", alter_sys=True)
            code = 0
        except SystemExit as ended:
            code = _code(ended)
        except BaseException:  # what Python itself does at the end of a process
            traceback.print_exc()
        atexit._run_exitfuncs()
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
    finally:
        os._exit(code)


def _code(ended: SystemExit) -> int:
    if ended.code is None:
        return 0
    if isinstance(ended.code, int):
        return ended.code
    print(ended.code, file=sys.stderr)
    return 1


if __name__ == "__main__":
    _main(int(sys.argv[1]))
