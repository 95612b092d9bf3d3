"""The streams of a command: one that is closed is nobody who reads, one of few letters gets what it knows."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TextIO


def open_streams() -> None:
    """Before anything is printed. A stream that is closed would otherwise be the next file that is opened."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free: this one
    if sys.stdout is None:
        sys.stdout = _nobody()
    if sys.stderr is None:
        sys.stderr = _nobody()
    for stream in (sys.stdout, sys.stderr):
        if not knows_all(stream) and hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")


def knows_all(stream: TextIO) -> bool:
    """Whether it takes letters of all languages."""
    return (getattr(stream, "encoding", None) or "utf-8").lower().startswith("utf")


def _nobody() -> TextIO:
    return Path(os.devnull).open("w", encoding="utf-8")  # as long as the program runs
