"""Write results into a folder, or one file, and be killed by SIGKILL just before the n-th change of the disk.

`python killed.py N PLACE CONTENT [--force] [--file]`; it says "done" where there are fewer changes than N.
"""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import Any

from ulna.formats import arriving, moving
from ulna.formats.output import new_file, output_folder

CHANGES = ("os.rename", "os.link", "os.remove", "os.mkdir", "os.rmdir", "os.chmod", "os.truncate")
NAMES = ("result.json", "arm.toml", "residuals.csv")


def main() -> None:
    last, place, content = int(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    force = "--force" in sys.argv
    count = 0

    def change() -> None:
        nonlocal count
        count += 1
        if count == last:
            os.kill(os.getpid(), signal.SIGKILL)

    def seen(event: str, args: tuple[Any, ...]) -> None:
        written = event == "open" and isinstance(args[2], int) and args[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
        if event in CHANGES or written:
            change()

    swap = moving.swap

    def swapped(one: Path, other: Path) -> bool:
        change()
        return swap(one, other)

    new_folder = moving.place_new_folder

    def placed(one: Path, other: Path) -> None:
        change()
        new_folder(one, other)

    arriving.swap, arriving.place_new_folder = swapped, placed  # type: ignore[assignment]
    sys.addaudithook(seen)
    if "--file" in sys.argv:
        with new_file(place, force=force) as staged:
            staged.write_text(content * 1000)
    else:
        with output_folder(place, NAMES, force) as staging:
            for name in NAMES:
                (staging / name).write_text(content * 1000)
    print("done")


main()
