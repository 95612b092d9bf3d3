"""Files that name others: they find those beside them, and nothing else of this machine."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath, PureWindowsPath
from shutil import copyfile
from typing import Any

from ulna.formats.toml import read_toml
from ulna.ground.errors import UlnaInputError
from ulna.serve.desk import Desk

KEYS = ("arm", "file", "features", "taken", "profile", "logo", "start")
"""Under which a file of Ulna's names another."""
GIVEN = "given"
"""In the folder of a job: what it was given."""


def usable(desk: Desk, digest: str) -> Path:
    """A file of the desk; one that was brought names no place of this machine. Raises UlnaInputError."""
    path = desk.path(digest)
    if desk.brought(path) and path.suffix.lower() == ".toml":
        document, _ = read_toml(path, "a file of Ulna (TOML)")
        for key, value in named_in(document):
            if _is_place(value):
                raise UlnaInputError(
                    f"{path.name}: key '{key}': got '{value[:80]}', a place of its own; expected the name of a file "
                    "that is brought with it. Name it alone."
                )
    return path


def named_in(table: Any) -> Iterator[tuple[str, str]]:
    """Key and name of each file that a document names."""
    for key, value in table.items():
        if key in KEYS and isinstance(value, str):
            yield key, value
        for each in value if isinstance(value, list) else [value]:
            if isinstance(each, dict):
                yield from named_in(each)


def _is_place(value: str) -> bool:
    posix, windows = PurePosixPath(value), PureWindowsPath(value)
    rooted = posix.is_absolute() or windows.is_absolute() or bool(windows.drive or windows.root)
    return rooted or ".." in posix.parts or ".." in windows.parts


def together(
    desk: Desk, folder: Path, main: str, beside: Sequence[str], named: Mapping[str, str] | None = None
) -> Path:
    """A file with those that it names beside it, in a folder of a job; where none are given, where it is. named: a name
    that it uses → the file that is meant. Raises UlnaInputError."""
    path = usable(desk, main)
    if not (beside or named):
        return path
    place = folder / GIVEN
    place.mkdir(parents=True)
    given = {path.name: path}
    for name, digest in [*((desk.info(each).name, each) for each in beside), *(named or {}).items()]:
        if given.setdefault(name, desk.path(digest)) != desk.path(digest):
            raise UlnaInputError(f"{name}: two files of this name are given; expected one. Leave one out.")
    for name, each in given.items():
        copyfile(each, place / name)
    return place / path.name


def with_arm(text: str, name: str) -> str:
    """A file's text, its top-level key `arm` naming this file."""
    head, bracket, rest = text.partition("\n[")
    return re.sub(r"(?m)^arm\s*=\s*(\"[^\"\n]*\"|'[^'\n]*')", f'arm = "{name}"', head, count=1) + bracket + rest
