"""``python -m fuzzing``: hostile inputs to every door, in processes of their own, for so many seconds.

The same seed gives the same inputs. Options: --seconds N, --seed S, --door NAME (repeatable), --inputs N (of each
door, in place of seconds), --first K, --jobs N, --page FILE; --only K runs one input here, --keep writes it as a
fossil.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
import threading
import time
from pathlib import Path

from benchmarks.machine import describe

from fuzzing.doors.registry import DOORS
from fuzzing.judging import judge
from fuzzing.page import page
from fuzzing.room import Room, make_room
from fuzzing.watching import ROOT, Worker, spread

Found = tuple[str, int, str]
FOSSILS = ROOT / "tests" / "fuzzing" / "fossils"


def run(room: Path, arguments: argparse.Namespace) -> tuple[dict[str, int], list[Found]]:
    """Counts by door and what was found, by `jobs` workers."""
    doors = arguments.door or list(DOORS)
    counts = dict.fromkeys(doors, 0)
    found: list[Found] = []
    todo = spread({door: DOORS[door].short for door in doors}, arguments.first, arguments.inputs)
    lock = threading.Lock()
    ends = time.monotonic() + arguments.seconds if arguments.inputs is None else float("inf")

    def work() -> None:
        worker = Worker(room, arguments.seed)
        try:
            while time.monotonic() < ends:
                with lock:
                    door, number = next(todo, ("", 0))
                if not door:
                    return
                wrong = worker.put(door, number)
                with lock:
                    counts[door] += 1
                    if wrong is not None:
                        found.append((door, number, wrong))
                        print(f"{door} {number}: {wrong}", flush=True)
        finally:
            worker.close()

    threads = [threading.Thread(target=work) for _ in range(arguments.jobs)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return counts, sorted(found)


def _only(room: Path, arguments: argparse.Namespace) -> None:
    (door,) = arguments.door
    opened = Room(room)
    trial = DOORS[door].trial(opened, arguments.seed, arguments.only)
    print("ulna", *map(repr, trial.arguments))
    for name, content in trial.files.items():
        print(f"{name}: {content[:3000]!r}")
    wrong = judge(trial, opened, room.parent)
    print(wrong or "nothing is wrong with it")
    if arguments.keep:
        FOSSILS.mkdir(parents=True, exist_ok=True)
        path = FOSSILS / f"{re.sub('[^a-z0-9]+', '-', door.lower())}-{arguments.seed}-{arguments.only}.json"
        path.write_text(trial.to_json(door, wrong or ""), encoding="utf-8")
        print(f"Written: {path.relative_to(ROOT)}")


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m fuzzing", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--door", action="append", choices=list(DOORS), metavar="NAME", help=", ".join(DOORS))
    parser.add_argument("--inputs", type=int, help="of each door, in place of seconds")
    parser.add_argument("--first", type=int, default=0, help="the first input's number")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", type=int, help="one input, in this process; needs one --door")
    parser.add_argument("--keep", action="store_true", help="write the input of --only to tests/fuzzing/fossils")
    parser.add_argument("--page", type=Path, help="where to write the page")
    arguments = parser.parse_args()
    if arguments.only is not None and len(arguments.door or ()) != 1:
        parser.error("--only needs one --door")
    with tempfile.TemporaryDirectory(prefix="fuzzing-") as folder:
        room = make_room(Path(folder) / "room")
        if arguments.only is not None:
            _only(room, arguments)
            return
        began = time.monotonic()
        counts, found = run(room, arguments)
    text = page(describe(), arguments.seed, time.monotonic() - began, counts, found)
    print(text)
    if arguments.page:
        arguments.page.write_text(text, encoding="utf-8")
        print(f"written: {arguments.page}", file=sys.stderr)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
