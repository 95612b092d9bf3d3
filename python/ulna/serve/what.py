"""What a file is, by what is written in it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from ulna.arm.given import as_arm
from ulna.formats.toml import read_toml
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import kept, worded
from ulna.serve.contract.files import FileKind

WHAT = 'a file of Ulna (TOML or JSON with a key "format")'
_MOST = 64 << 20
"""Bytes of a JSON file that is looked into."""
TABLES = {
    ".csv",
    ".txt",
    ".tsv",
    ".xlsx",
    ".xlsm",
    ".xls",
    ".ods",
    ".parquet",
    ".arrow",
    ".feather",
    ".h5",
    ".hdf5",
    ".mat",
}


def _arm(path: Path) -> str:
    arm = as_arm(path)
    return worded("arm '{arm}', {joints} joints", arm=arm.name, joints=arm.n)


def _result(path: Path) -> str:
    arm = as_arm(path)
    return worded("calibrated arm '{arm}', {joints} joints", arm=arm.name, joints=arm.n)


def _plain(words: str) -> Callable[[Path], str]:
    return lambda _: words


KINDS: dict[str, tuple[FileKind, Callable[[Path], str]]] = {
    "ulna-arm": (FileKind.ARM, _arm),
    "ulna-result": (FileKind.RESULT, _result),
    "ulna-plan": (FileKind.PLAN, _plain(worded("a plan"))),
    "ulna-plan-result": (FileKind.PLANNED, _plain(worded("what was planned"))),
    "ulna-study": (FileKind.STUDY, _plain(worded("a study"))),
    "ulna-source": (FileKind.SOURCE, _plain(worded("a source of readings"))),
    "ulna-protocol": (FileKind.PROTOCOL, _plain(worded("the protocol of a check"))),
    "ulna-check": (FileKind.CHECK, _plain(worded("what a check found"))),
    "ulna-verify": (FileKind.TEST, _plain(worded("an acceptance test"))),
    "ulna-verification": (FileKind.VERIFICATION, _plain(worded("what an acceptance test found"))),
    "ulna-profile": (FileKind.PROFILE, _plain(worded("the profile of an acceptance test"))),
    "ulna-lab": (FileKind.LABORATORY, _plain(worded("a laboratory"))),
}
"""Name of a format → what it is, and a few words about it."""
OTHERS = {
    ".urdf": worded("a drawing (URDF): for a study of readings, or ulna import urdf"),
    ".png": worded("a picture: for a laboratory's logo"),
    ".svg": worded("a picture: for a laboratory's logo"),
}
"""Ending of files that are used with others → a few words."""


def what_is(path: Path) -> tuple[FileKind, str]:
    """What it is and a few words about it; of what cannot be used, why."""
    suffix = path.suffix.lower()
    if suffix in TABLES:
        return FileKind.TABLE, worded("a table of readings")
    try:
        kind = _format(path)
        if kind not in KINDS:
            return FileKind.OTHER, OTHERS.get(suffix, worded("nothing that is known here"))
        found, said = KINDS[kind]
        return found, said(path)
    except UlnaInputError as error:
        return FileKind.OTHER, kept(error)


def _format(path: Path) -> str:
    suffix = path.suffix.lower()
    if suffix == ".toml":
        named = read_toml(path, WHAT)[0].get("format")
    elif suffix == ".json" and path.stat().st_size <= _MOST:
        try:
            document = json.loads(path.read_bytes())
        except (ValueError, RecursionError):
            return ""
        named = document.get("format") if isinstance(document, dict) else None
    else:
        return ""
    return named.partition("/")[0] if isinstance(named, str) else ""
