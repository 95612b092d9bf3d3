"""What a file says that it holds, beside its size: asked before anything is unpacked.

Compression and runs of equal values make any number of values of a few bytes. Readings do not shrink so much: angles
are hardly compressible at all, labels and constant columns are few beside them.
"""

from __future__ import annotations

from pathlib import Path

from ulna.ground.errors import UlnaInputError

ALWAYS_BYTES = 128 << 20
"""Whatever the file's size is: no harm is done by so much."""
MOST_TIMES = 64
"""Of the file's own size."""
NUMBER_BYTES, TEXT_BYTES = 8, 128
"""Of one value in memory; of a text it is the object, whatever its length."""


def too_much(path: Path, size: int) -> bool:
    """Whether values of `size` bytes are more than a file of readings can be."""
    return size > ALWAYS_BYTES and size > MOST_TIMES * path.stat().st_size


def check_unpacked(path: Path, size: int, whose: str) -> None:
    """whose: "its columns". Raises UlnaInputError."""
    if too_much(path, size):
        raise UlnaInputError(
            f"{path}: {whose} would take {in_words(size)}, and the file has {in_words(path.stat().st_size)}; expected "
            f"readings, which shrink {MOST_TIMES} times at most. It is damaged, or no file of readings: check the copy."
        )


def in_words(size: int) -> str:
    """A number of bytes: "5.4 GB"."""
    for unit, bytes_ in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if size >= bytes_:
            return f"{size / bytes_:.3g} {unit}"
    return f"{size} bytes"
