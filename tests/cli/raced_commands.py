"""``python -m tests.cli.raced_commands``: two processes write to one place at the same moment, so many times.

A process that has loaded everything, and done nothing yet, forks two for each race. They wait for each other when they
begin, and again where the result moves to its place. Without --force one wins and the other says so; with --force what
stands is one's, whole. What others have there stays. Options: --races N (of each command, with and without --force),
--command NAME (repeatable), --seed S. It ends with 1 where anything else was seen.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import io
import json
import mmap
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from random import Random
from typing import Any

from tests.cli.faults import prepared

PATIENCE_S = 20.0
"""Of one who waits for the other; the other may be refused before it comes to the place."""
SAID = ("exists already and is not overwritten", "another batch is writing here")
NEW = "new --readings bars.csv --artefact bar --angle-unit rad --zeros known --signs known --length-unit mm "


@dataclass(frozen=True)
class Raced:
    """What both run. {out} is the place."""

    words: tuple[str, str]
    """So that what each writes can be told from the other's."""
    out: str
    long: bool = False
    """Whether it has the place to itself from the beginning, also with --force."""


RACED = {
    "calibrate": Raced(("calibrate study.toml -o {out}", "calibrate other.toml -o {out}"), "out"),
    "report": Raced(("report done -o {out}", "report done --language de -o {out}"), "report.html"),
    "certificate": Raced(
        ("certificate done laboratory.toml -o {out}", "certificate done other-laboratory.toml -o {out}"),
        "certificate.xml",
    ),
    "batch": Raced(("batch arms -o {out}", "batch other-arms -o {out}"), "out", long=True),
    "new": Raced(
        (
            NEW + "--length 443.172 --arm platinum.toml -o {out}",
            NEW + "--length 443.173 --arm other-platinum.toml -o {out}",
        ),
        "out",
    ),
}
PLACES = ("none", "notes", "folder")
"""What stands where a folder is written: nothing; a file of others; a folder of others, so that files go one by one."""


@dataclass
class Counted:
    """How the races of one command ended."""

    races: int = 0
    won: Counter[int] = field(default_factory=Counter)
    """By which of the two; -1: what stands is nobody's."""
    wrong: list[str] = field(default_factory=list)


def folder_for(folder: Path) -> Path:
    """What both read; the second's inputs differ a little."""
    prepared(folder)
    for name, other in (("study.toml", "other.toml"), ("laboratory.toml", "other-laboratory.toml")):
        shutil.copy(folder / name, folder / other)
    shutil.copytree(folder / "arms", folder / "other-arms")
    for path in (folder / "other.toml", *(folder / "other-arms").rglob("study.toml")):
        text = path.read_text()
        changed = text.replace("443.172", "443.182")
        assert changed != text
        path.write_text(changed)
    arm = (folder / "platinum.toml").read_text()
    changed = arm.replace('name = "', 'name = "another ', 1)
    assert changed != arm
    (folder / "other-platinum.toml").write_text(changed)
    lab = folder / "other-laboratory.toml"
    lab.write_text(re.sub(r'(?m)^(number|identifier) = "[^"]*"', r'\1 = "another"', lab.read_text()))
    assert lab.read_text() != (folder / "laboratory.toml").read_text()
    return folder


class Meeting:
    """Two processes wait for each other, without sleep: memory that both see."""

    def __init__(self) -> None:
        self._seen = mmap.mmap(-1, 64)

    def come(self, me: int, stage: int) -> None:
        """Until the other has come to this stage as well, or has ended."""
        self._seen[me] = max(self._seen[me], stage)
        until = time.monotonic() + PATIENCE_S
        while self._seen[1 - me] < stage and time.monotonic() < until:
            os.sched_yield()

    def leave(self, me: int) -> None:
        self._seen[me] = 255


class AtThePlace:
    """In place of the lock that is held while files move: the other comes to this point too, then both go on."""

    def __init__(self, lock: Any, meeting: Meeting, me: int, delay_s: float) -> None:
        self._lock, self._meeting, self._me, self._delay_s, self._stage = lock, meeting, me, delay_s, 2

    def __enter__(self) -> None:
        self._lock.__enter__()
        self._meeting.come(self._me, self._stage)
        self._stage += 1
        until = time.perf_counter() + self._delay_s
        while time.perf_counter() < until:
            pass

    def __exit__(self, *error: object) -> None:
        self._lock.__exit__(*error)


LOADED = (
    "calibration.batch", "calibration.result", "cli.batch", "cli.calibrate", "cli.certificate", "cli.new", "cli.report",
    "documents.certificate", "documents.gather", "documents.html.page", "documents.write", "proposals.propose",
    "proposals.write",
)  # fmt: skip
"""So that two who begin at once come to the place at about the same moment."""


def serve() -> None:
    """Races, one after the other: a line of JSON each on stdin, how both ended on stdout."""
    from ulna.formats import output

    for name in LOADED:
        importlib.import_module(f"ulna.{name}")
    for line in sys.stdin:
        asked = json.loads(line)
        meeting = Meeting()
        children = []
        for me in (0, 1):
            read, write = os.pipe()
            child = os.fork()
            if child == 0:
                os.close(read)
                if asked["meet"]:
                    output.MOVING = AtThePlace(output.MOVING, meeting, me, asked["delays"][me])  # type: ignore[assignment]
                ended = _run(asked["words"][me], meeting, me)
                with os.fdopen(write, "w") as answer:
                    json.dump(ended, answer)
                os._exit(0)
            os.close(write)
            children.append((child, read))
        ends = []
        for child, read in children:
            with os.fdopen(read) as answer:
                ends.append(json.loads(answer.read() or '[-1, "it died"]'))
            os.waitpid(child, 0)
        print(json.dumps(ends), flush=True)


def _run(words: list[str], meeting: Meeting, me: int) -> tuple[int, str]:
    from ulna.__main__ import main

    heard = io.StringIO()
    sys.argv = ["ulna", *words]
    code: Any = 0
    meeting.come(me, 1)
    try:
        with contextlib.redirect_stderr(heard), contextlib.redirect_stdout(heard):
            main()
    except SystemExit as end:
        code = end.code or 0
    finally:
        meeting.leave(me)
    return code, heard.getvalue()


def contents(out: Path) -> dict[str, bytes]:
    """What stands, without the moment and the time it took; hidden places too, which nobody should leave."""
    files = [out] if out.is_file() else [each for each in out.rglob("*") if each.is_file()]
    return {each.relative_to(out).as_posix(): _timeless(each.read_bytes()) for each in files}


def _timeless(content: bytes) -> bytes:
    content = re.sub(rb'"(time|created|duration_s)": ("[^"]*"|[0-9.e-]+)', rb'"\1": 0', content)
    return re.sub(rb"20\d\d-\d\d-\d\d[T ]\d\d:\d\d(:\d\d)?([.]\d+)?|<time>[^<]*", b"", content)


class Forks:
    """The process that has loaded everything; a context manager, which ends it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __enter__(self) -> Forks:
        paths = os.pathsep.join(filter(None, sys.path))
        self._process = subprocess.Popen(
            [sys.executable, "-c", "from tests.cli.raced_commands import serve; serve()"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=self._folder,
            env=os.environ | {"TERM": "dumb", "COLUMNS": "300", "PYTHONPATH": paths, "RAYON_NUM_THREADS": "1"},
        )
        return self

    def __exit__(self, *error: object) -> None:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.close()
        self._process.wait(60)
        self._process.stdout.close()

    def ends(self, words: list[list[str]], meet: bool, delays: tuple[float, float]) -> list[tuple[int, str]]:
        """Of both, the exit code and what was said."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps({"words": words, "meet": meet, "delays": delays}) + "\n")
        self._process.stdin.flush()
        return [(code, said) for code, said in json.loads(self._process.stdout.readline())]


class Races:
    """Of one command."""

    def __init__(self, forks: Forks, command: Raced, force: bool, seed: int = 1) -> None:
        self.forks, self.command, self.force, self.seed = forks, command, force, seed
        self.alone = []
        """What each writes where it has the place to itself."""
        for me in (0, 1):
            with tempfile.TemporaryDirectory(prefix="raced-") as name:
                out = Path(name).resolve() / self.command.out
                ends = forks.ends([self._words(me, out), ["--version"]], False, (0, 0))
                assert ends[0][0] == 0, ends
                self.alone.append(contents(out))
        assert all(self.alone[0][name] != self.alone[1].get(name) for name in self.alone[0])

    def _words(self, me: int, out: Path) -> list[str]:
        words = [each.replace("{out}", str(out)) for each in self.command.words[me].split()]
        return [*words, *(["--force"] if self.force else [])]

    def race(self, number: int) -> tuple[int, str]:
        """Who won, and what is wrong."""
        chance = Random(f"{self.seed} {number}")
        place = PLACES[number % 3]
        with tempfile.TemporaryDirectory(prefix="raced-") as name:
            here = Path(name).resolve()
            out = here / self.command.out
            theirs = self._lay(out, place)
            # nine of ten meet where files move; one runs as it comes
            delays = (chance.uniform(0, 3e-4), chance.uniform(0, 3e-4))
            meet = number % 10 != 9 or self.command.long
            ends = self.forks.ends([self._words(me, out) for me in (0, 1)], meet, delays)
            standing = contents(out) if out.exists() else {}
            left = [each.name for each in here.rglob("*.partial*")]
            winner, wrong = self._judged(ends, standing, theirs)
            if left:
                wrong = f"left behind: {left}"
            return winner, f"race {number}, {place}: {wrong}; {ends}" if wrong else ""

    def _lay(self, out: Path, place: str) -> dict[str, bytes]:
        """What others have there, or, with --force, what an earlier run wrote."""
        if "." in self.alone[0]:
            if self.force and place != "none":
                out.write_text("earlier")
            return {}
        theirs = {"none": {}, "notes": {"notes.txt": b"mine"}, "folder": {"kept/notes.txt": b"mine"}}[place]
        earlier = dict.fromkeys(self.alone[0], b"earlier") if self.force and place != "none" else {}
        for name, content in (theirs | earlier).items():
            (out / name).parent.mkdir(parents=True, exist_ok=True)
            (out / name).write_bytes(content)
        return theirs

    def _judged(
        self, ends: list[tuple[int, str]], standing: dict[str, bytes], theirs: dict[str, bytes]
    ) -> tuple[int, str]:
        if {name: standing.get(name) for name in theirs} != theirs:
            return -1, "others' files are not as they were"
        ours = {name: each for name, each in standing.items() if name not in theirs}
        owner = next((me for me in (0, 1) if self.alone[me] == ours), None)
        if owner is None:
            return -1, f"{sorted(ours)} is nobody's, or not whole"
        if self.force and not self.command.long:
            return owner, "" if [code for code, _ in ends] == [0, 0] else "with --force both write"
        code, said = ends[1 - owner]
        if ends[owner][0] != 0:
            return owner, "the winner was refused"
        return owner, "" if code == 2 and any(each in said for each in SAID) else "the other does not say so"


def raced(forks: Forks, name: str, force: bool, races: int, seed: int = 1) -> Counted:
    """So many races of a command."""
    counted, run = Counted(), Races(forks, RACED[name], force, seed)
    for number in range(races):
        winner, wrong = run.race(number)
        counted.races += 1
        counted.won[winner] += 1
        if wrong:
            counted.wrong.append(wrong)
    return counted


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.cli.raced_commands", description=(__doc__ or "")[:120])
    parser.add_argument("--races", type=int, default=50)
    parser.add_argument("--command", action="append", choices=list(RACED))
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    failed = False
    with tempfile.TemporaryDirectory(prefix="raced-bench-") as name, Forks(folder_for(Path(name).resolve())) as forks:
        for command, force in product(arguments.command or RACED, (False, True)):
            found = raced(forks, command, force, arguments.races, arguments.seed)
            failed |= bool(found.wrong)
            print(
                f"{command}{' --force' * force}: {found.races} races, won by the first {found.won[0]}, by the "
                f"second {found.won[1]}, {len(found.wrong)} wrong",
                flush=True,
            )
            for line in found.wrong:
                print(f"  {line}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
