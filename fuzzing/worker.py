"""``python -m fuzzing.worker``: inputs one after the other, in a process that may die of one of them.

Reads lines ``door number`` on stdin; writes a line of JSON on what was stdout when each begins and when it ends.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
from pathlib import Path

from fuzzing.doors.registry import DOORS
from fuzzing.judging import judge
from fuzzing.room import Room

KILLS = "FUZZING_KILLS"
"""Names an input at which the worker dies: the test of who watches it."""


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--room", type=Path, required=True)
    parser.add_argument("--aside", type=Path, required=True)
    parser.add_argument("--seed", type=int, required=True)
    arguments = parser.parse_args()
    room = Room(arguments.room)
    answers = os.fdopen(os.dup(1), "w", encoding="ascii")

    def answer(**said: object) -> None:
        answers.write(json.dumps(said) + "\n")
        answers.flush()

    for line in sys.stdin:
        door, _, number = line.rstrip("\n").rpartition(" ")
        answer(begun=[door, int(number)])
        if os.environ.get(KILLS) == f"{door} {number}":
            os.kill(os.getpid(), signal.SIGSEGV)
        trial = DOORS[door].trial(room, arguments.seed, int(number))
        answer(found=judge(trial, room, arguments.aside, DOORS[door].seconds))


if __name__ == "__main__":
    main()
