"""Compiling small C and C++ programs for the peers that are libraries of those languages."""

import os
import shutil
import subprocess
from pathlib import Path

from benchmarks.peers import MissingPeerError

#: what every native peer is compiled with
FLAGS = ["-O3", "-march=native"]


def compile_to(output: Path, source: Path, extra: list[str], cxx: bool) -> None:
    """Compile one file; raises MissingPeerError with the compiler's first complaint."""
    names = ("c++", "g++", "clang++") if cxx else ("cc", "gcc", "clang")
    compiler = next((found for name in names if (found := shutil.which(name))), None)
    if compiler is None:
        raise MissingPeerError(f"no compiler found ({', '.join(names)})")
    command = [compiler, *FLAGS, str(source), "-o", str(output), *extra]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        complaint = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr[:200])
        # without the paths of this machine, which the page would show
        raise MissingPeerError(f"does not compile here: {complaint.split('error:')[-1].strip()}")


def run(program: Path, arguments: list[str], libraries: Path | None = None) -> str:
    """Run a compiled peer and return what it printed."""
    environment = dict(os.environ)
    if libraries is not None:
        environment["LD_LIBRARY_PATH"] = str(libraries)
    done = subprocess.run([str(program), *arguments], capture_output=True, text=True, check=False, env=environment)
    if done.returncode != 0:
        raise MissingPeerError(f"does not run here: {(done.stderr or done.stdout).strip()[:200]}")
    return done.stdout
