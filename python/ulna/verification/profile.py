"""Profiles of acceptance tests: those that come with Ulna, by name, and the user's own, by path."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from ulna.formats.models import check_kind, fill
from ulna.formats.toml import check_format, read_toml
from ulna.ground.errors import UlnaInputError, nearest
from ulna.verification.kinds.kind import TestTable
from ulna.verification.kinds.registry import KINDS
from ulna.verification.profile_tables import ProfileFile

WHAT = 'a profile (TOML, format = "ulna-profile/1")'

#: profiles based on profiles: no chain that anybody means is longer
MOST_STEPS = 8
MOST_TOUCHES = 100_000


@dataclass(frozen=True)
class Profile:
    """A profile, and where it was read."""

    file: ProfileFile
    path: Path
    sha256: str
    """Of that file alone, not of those that it is based on."""


def shipped() -> dict[str, Path]:
    """The profiles that come with Ulna, by name."""
    folder = Path(str(files("ulna.verification") / "profiles"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_profile(name: str, beside: Path, asked: str) -> Profile:
    """By name, or by path relative to the folder `beside`; asked: the key that names it. Raises UlnaInputError."""
    path = _path(name, beside, asked)
    document, sha256 = _document(path, [])
    check_tests(document, path)
    file = fill(ProfileFile, document, path)
    if file.limit and file.unit is None:
        raise UlnaInputError(
            f"{path}: key 'unit' is missing, but there are limits; units are never guessed. Add unit = "
            '"mm" (or m, in).'
        )
    check_counts(file.test, path)
    return Profile(file, path, sha256)


def check_counts(tests: Mapping[str, TestTable], path: Path) -> None:
    """Nobody touches more than a hundred thousand times. Raises UlnaInputError."""
    for name, test in tests.items():
        counts = {key: value for key, value in test if type(value) is int}
        if math.prod(counts.values()) > MOST_TOUCHES:
            shown = " × ".join(f"{value} {key}" for key, value in counts.items())
            raise UlnaInputError(
                f"{path}: key 'test.{name}': {shown}, more than anybody measures; expected {MOST_TOUCHES} touches at "
                "most. Correct one of them."
            )


def _path(name: str, beside: Path, asked: str) -> Path:
    known = shipped()
    if name in known:
        return known[name]
    path = beside / name
    if not path.exists() and path.suffix.lower() != ".toml":
        raise UlnaInputError(
            f"{asked}: got '{name}', no profile that comes with Ulna and no file.{nearest(name, known)} Name one, or "
            "the path of your own."
        )
    return path


def _document(path: Path, above: list[Path]) -> tuple[dict[str, Any], str]:
    """The document with what it is based on filled in."""
    if path.resolve() in above or len(above) > MOST_STEPS:
        raise UlnaInputError(f"{path}: key 'based_on': the profiles are based on each other in a circle. Correct one.")
    document, sha256 = read_toml(path, WHAT)
    check_format(document, path, "ulna-profile")
    base = document.get("based_on")
    if not isinstance(base, str):
        return document, sha256
    under, _ = _document(_path(base, path.parent, f"{path}: key 'based_on'"), [*above, path.resolve()])
    merged = _merged(under, document)
    tests = merged.get("test")
    without = document.get("without", [])
    if not (isinstance(without, list) and all(isinstance(name, str) for name in without)):
        raise UlnaInputError(
            f"{path}: key 'without': got {str(without)[:60]}, expected a list of names of tests of '{base}'. Correct "
            "it."
        )
    if not isinstance(tests, dict):
        if not without:
            return merged, sha256
        raise UlnaInputError(f"{path}: key 'test': got {str(tests)[:60]}, expected tables [test.NAME]. Correct it.")
    for name in without:
        if name not in under.get("test", {}):
            raise UlnaInputError(
                f"{path}: key 'without': got '{name}', no test of '{base}'.{nearest(name, under.get('test', {}))} "
                "Correct it."
            )
        tests.pop(name, None)
    return merged, sha256


def _merged(under: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    """Tables key by key; of other values the upper one. Limits that grow are replaced whole."""
    found = dict(under)
    for key, value in over.items():
        own = found.get(key)
        if not (isinstance(own, dict) and isinstance(value, dict)):
            found[key] = value
        elif key == "limit":
            found[key] = {**own, **value}
        else:
            found[key] = _merged(own, value)
    return found


def check_tests(document: dict[str, Any], path: Path) -> None:
    """Whether all are of a known kind. Raises UlnaInputError."""
    tests = document.get("test")
    for name, table in tests.items() if isinstance(tests, dict) else ():
        check_kind(table, f"test.{name}", list(KINDS), path)
