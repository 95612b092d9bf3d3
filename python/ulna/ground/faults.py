"""What is nobody's fault but Ulna's: said so, with what it takes to find it."""

from __future__ import annotations

import traceback
from pathlib import Path

HERE = Path(__file__).resolve().parents[1]


def fault(error: BaseException) -> str:
    """One sentence with the error and the place in Ulna where it came from."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [frame for frame in frames if Path(frame.filename).is_relative_to(HERE)]
    at = ""
    if ours:
        last = ours[-1]
        at = f" at {Path(last.filename).relative_to(HERE.parent).as_posix()}:{last.lineno}"
    said = " ".join(str(error).split())[:200]
    return f"this is a fault of Ulna's{at}: {type(error).__name__}{f': {said}' if said else ''}. Please report it."
