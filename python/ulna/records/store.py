"""Files kept by their SHA-256: written once, read-only, never changed, in a folder that can be moved whole."""

from __future__ import annotations

import hashlib
import os
import re
import secrets
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from ulna.formats.moving import flush
from ulna.ground.errors import UlnaInputError

_NAME = re.compile(r"[0-9a-f]{64}")


def sha256_of(content: bytes) -> str:
    """As the store names it."""
    return hashlib.sha256(content).hexdigest()


def is_name(name: str) -> bool:
    """Whether it is one that a store gives."""
    return _NAME.fullmatch(name) is not None


class Store:
    """A folder of files, each named by what is in it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def place(self, sha256: str) -> Path:
        """Where a file is, or would be. Raises ValueError for what is no SHA-256: no other name is ever opened."""
        if not is_name(sha256):
            raise ValueError(f"no SHA-256: {sha256!r}")
        return self.folder / sha256[:2] / sha256

    def put(self, content: bytes) -> str:
        """Keep it; its SHA-256. On the disk when this returns, or not there at all. Raises OSError."""
        name = sha256_of(content)
        place = self.place(name)
        if place.exists():
            return name
        place.parent.mkdir(parents=True, exist_ok=True)
        staged = place.parent / f".{secrets.token_hex(6)}.partial"
        try:
            handle = os.open(staged, os.O_CREAT | os.O_EXCL | os.O_WRONLY | getattr(os, "O_BINARY", 0), 0o444)
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
                stream.flush()
                os.fsync(stream.fileno())
            staged.replace(place)  # two who keep the same write the same
        finally:
            with suppress(OSError):
                staged.unlink()
        flush(place.parent)
        flush(self.folder)
        return name

    def get(self, sha256: str) -> bytes:
        """What is kept under a name. Raises UlnaInputError where it is not there, or not what the name says."""
        place = self.place(sha256)
        try:
            content = place.read_bytes()
        except FileNotFoundError:
            raise UlnaInputError(
                f"{place}: is not there; expected the file with this SHA-256, which the record names. Restore it from "
                "a backup."
            ) from None
        if sha256_of(content) != sha256:
            raise UlnaInputError(
                f"{place}: the file was changed: its SHA-256 is {sha256_of(content)}; expected that of its name. "
                "Restore it from a backup."
            )
        return content

    def names(self) -> Iterator[str]:
        """Of all that is kept, in order."""
        for folder in sorted(self.folder.glob("[0-9a-f][0-9a-f]")):
            for path in sorted(folder.iterdir()) if folder.is_dir() else ():
                if is_name(path.name) and path.is_file():
                    yield path.name
