"""``python -m tests.cli.killed_commands``: whole commands, killed at each system call that changes the output's place.

A run that nothing injures says which calls there are (strace); then there is one run for each of them, in which its
process is killed (SIGKILL) as it enters that call. What stands afterwards must be what stood before or what the
command writes, each result whole, and what others put there untouched. Options: --command NAME (repeatable),
--every N (each N-th call only), --jobs N. It ends with 1 where anything else was seen.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from tests.cli.faults import prepared

CALLS = (
    "openat", "write", "writev", "pwrite64", "sendfile", "copy_file_range", "ftruncate", "fallocate", "rename",
    "renameat", "renameat2", "link", "linkat", "symlink", "unlink", "unlinkat", "mkdir", "mkdirat", "rmdir", "chmod",
    "fchmod", "fchmodat", "utimensat", "fsync", "fdatasync",
)  # fmt: skip
TRIES = 3
"""Of one call, where the process had ended, or was killed, elsewhere."""
KNOWN_NAMES = "import secrets\nsecrets.token_hex = lambda count: '0' * 2 * count\n"
"""So that staging places have the same names in every run, and strace may be told them."""


@dataclass(frozen=True)
class Command:
    """What is run, and what of its output comes or stays as one."""

    words: str
    """{out} is the output, a file or a folder."""
    out: str
    units: tuple[str, ...] = ("",)
    """Below the output, each of them whole: one of old and new."""


COMMANDS = {
    "calibrate": Command("calibrate study.toml -o {out}", "out"),
    "batch": Command("batch arms -o {out}", "out", ("one/study", "two/study", "batch.json")),
    "report": Command("report done -o {out}", "report.html"),
    "certificate": Command("certificate done laboratory.toml -o {out}", "certificate.xml"),
    "certificate pdf": Command("report done --lab laboratory.toml -o {out}", "certificate.pdf"),
}


@dataclass
class Counted:
    """What became of one command."""

    calls: int = 0
    old: int = 0
    new: int = 0
    partly: int = 0
    """Of several results some old, some new, each whole."""
    missed: list[str] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Target:
    """One call of a run: the `number`-th of its name on a path, in its thread."""

    call: str
    paths: tuple[str, ...]
    """Below the place. strace looks for the first."""
    number: int

    def __str__(self) -> str:
        return f"{self.call} {' '.join(self.paths)} ({self.number})"


def lacking_strace() -> bool:
    """Whether it is not here, or may not look at other processes."""
    if shutil.which("strace") is None:
        return True
    return subprocess.run(["strace", "-qq", "-o", os.devnull, "true"], capture_output=True, check=False).returncode != 0


def calls(log: Path, place: Path) -> list[tuple[str, Target]]:
    """The calls of a log that name something in a place, whether they change it or not: each as its line."""
    counts: Counter[tuple[str, str, str]] = Counter()
    found = []
    for line in log.read_text(errors="replace").splitlines():
        seen = re.match(r"(\d+) +(\w+)\(", line)
        if seen is None:
            continue
        asked = re.split(r"\) += ", line)[0]  # whoever is killed has no answer
        paths = tuple(dict.fromkeys(re.findall(re.escape(str(place)) + r"([^\"<>]*)[\">]", asked)))
        for path in paths:
            counts[seen[1], seen[2], path] += 1
        if paths and not re.search(r"write\([12]<", asked):
            found.append((line, Target(seen[2], paths, counts[seen[1], seen[2], paths[0]])))
    return found


def contents(out: Path) -> dict[str, bytes]:
    """What a reader sees, hidden staging places apart, without the moment and the time it took."""
    files = [out] if out.is_file() else [each for each in out.rglob("*") if each.is_file()]
    shown = [each for each in files if not any(part.startswith(".") for part in each.relative_to(out.parent).parts)]
    return {each.relative_to(out).as_posix(): _timeless(each.read_bytes()) for each in shown}


def _timeless(content: bytes) -> bytes:
    return re.sub(rb'"(time|created|duration_s)": ("[^"]*"|[0-9.e-]+)', rb'"\1": 0', content)


def of_unit(standing: dict[str, bytes], unit: str) -> dict[str, bytes]:
    """The files of one result."""
    return {name: each for name, each in standing.items() if not unit or name == unit or name.startswith(f"{unit}/")}


class Bench:
    """A command in a folder that has what it reads."""

    def __init__(self, folder: Path, command: Command, force: bool) -> None:
        self.folder, self.command, self.force = folder, command, force
        (folder / "known").mkdir(exist_ok=True)
        (folder / "known" / "sitecustomize.py").write_text(KNOWN_NAMES)
        self.whole: dict[str, bytes] = {}
        """What it writes when nothing injures it, as bytes."""
        with tempfile.TemporaryDirectory(prefix="killed-") as name:
            place = Path(name).resolve()
            self.run(place, [])
            out = place / command.out
            files = [out] if out.is_file() else [each for each in out.rglob("*") if each.is_file()]
            self.whole = {each.relative_to(out).as_posix(): each.read_bytes() for each in files}
            self.new = contents(out)
        with tempfile.TemporaryDirectory(prefix="killed-") as name:
            place = Path(name).resolve()
            self.lay(place)
            self.run(place, ["-e", f"trace={','.join(CALLS)}"])
            seen = calls(place.parent / f"{place.name}.log", place)
            self.targets = [target for line, target in seen if target.call != "openat" or "O_CREAT" in line]
            (place.parent / f"{place.name}.log").unlink()

    def run(self, place: Path, options: list[str]) -> int:
        """Its exit code, below zero where it was killed. The log is beside the place."""
        words = [each.replace("{out}", str(place / self.command.out)) for each in self.command.words.split()]
        log = place.parent / f"{place.name}.log"
        traced = ["strace", "-f", "-qq", "-y", "-o", str(log), *options] if options else []
        paths = [str(self.folder / "known"), *filter(None, sys.path)]
        done = subprocess.run(
            [*traced, sys.executable, "-m", "ulna", *words, *(["--force"] if self.force else [])],
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=120,
            env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1", "TERM": "dumb", "PYTHONPATH": os.pathsep.join(paths)},
            check=False,
        )
        assert done.returncode in (0, -9), done.stderr
        return done.returncode

    def lay(self, place: Path) -> dict[str, bytes]:
        """With --force an earlier result, which is one blank line longer in each file; a file of others in any case
        where the output is a folder."""
        out = place / self.command.out
        if "." not in self.whole:
            out.mkdir()
            (out / "notes.txt").write_text("mine")
        for name, content in self.whole.items() if self.force else ():
            path = out / name if name != "." else out
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content + b"\n")
        return contents(out)

    def kill(self, target: Target) -> tuple[str, str]:
        """What stands: "old", "new", "partly", "missed", or "wrong" and what is wrong."""
        for _ in range(TRIES):
            with tempfile.TemporaryDirectory(prefix="killed-") as name:
                place = Path(name).resolve()
                before = self.lay(place)
                path = f"{place}{target.paths[0]}"
                inject = ["-P", path, "-e", f"trace={target.call}"]
                inject += ["-e", f"inject={target.call}:signal=KILL:when={target.number}"]
                code = self.run(place, inject)
                log = place.parent / f"{place.name}.log"
                last = [each for _, each in calls(log, place)][-1:]
                log.unlink()
                said = self._judged(before, contents(place / self.command.out))
                if said[0] == "wrong" or (code == -9 and last == [target]):
                    return said
        return "missed", str(target)

    def _judged(self, before: dict[str, bytes], standing: dict[str, bytes]) -> tuple[str, str]:
        ends = []
        for unit in self.command.units:
            now = {name: each for name, each in of_unit(standing, unit).items() if name != "notes.txt"}
            old = {name: each for name, each in of_unit(before, unit).items() if name != "notes.txt"}
            if now == old:
                ends.append("old")
            elif now == of_unit(self.new, unit):
                ends.append("new")
            else:
                return "wrong", f"{unit or self.command.out}: {sorted(now)} is neither old nor new"
        known = {name for unit in self.command.units for name in of_unit(standing, unit)} | {"notes.txt"}
        if standing.get("notes.txt") != before.get("notes.txt") or standing.keys() - known:
            return "wrong", f"others' files: {sorted(standing)}"
        if ends == sorted(ends, key=["new", "old"].index):  # one after the other, the last says that all are there
            return ("partly" if len(set(ends)) > 1 else ends[0]), ""
        return "wrong", f"{ends} of {self.command.units}"


def tried(folder: Path, name: str, force: bool, every: int = 1, jobs: int = 1) -> Counted:
    """A command killed at each of its calls, or at every so many-th."""
    bench = Bench(folder, COMMANDS[name], force)
    chosen = bench.targets[every // 2 :: every]
    counted = Counted(len(chosen))
    with ThreadPoolExecutor(jobs) as pool:
        for target, (end, what) in zip(chosen, pool.map(bench.kill, chosen), strict=True):
            if end == "missed":
                counted.missed.append(what)
            elif end == "wrong":
                counted.wrong.append(f"{target}: {what}")
            else:
                setattr(counted, end, getattr(counted, end) + 1)
    return counted


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.cli.killed_commands", description=(__doc__ or "")[:120])
    parser.add_argument("--command", action="append", choices=list(COMMANDS))
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    if lacking_strace():
        parser.error("strace is not here, or may not be used: tools/real_parts.sh installs it")
    failed = False
    with tempfile.TemporaryDirectory(prefix="killed-bench-") as name:
        folder = prepared(Path(name).resolve())
        for command in arguments.command or COMMANDS:
            for force in (False, True):
                found = tried(folder, command, force, arguments.every, arguments.jobs)
                failed |= bool(found.missed or found.wrong)
                print(
                    f"{command}{' --force' * force}: killed at {found.calls} calls: {found.old} old, {found.new} new, "
                    f"{found.partly} partly, {len(found.missed)} missed, {len(found.wrong)} wrong",
                    flush=True,
                )
                for line in [*found.missed, *found.wrong]:
                    print(f"  {line}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
