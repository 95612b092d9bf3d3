"""Reading TOML and JSON documents: a missing, unreadable or foreign file is told in one message."""

from __future__ import annotations

import hashlib
import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any

from ulna.formats.names import check_path
from ulna.formats.spelling import MOST
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import worded

#: no hand-written file comes near it; a table, or a device that never ends, named by mistake does
MOST_BYTES = 8 << 20
MOST_STEPS, MOST_TABLES = 16, 400_000
"""Names of one key with points between, and of all of them together: each is a table of its own, of a kilobyte."""
_PART = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
_STEPS = re.compile(rf"(?<![A-Za-z0-9_-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART})++[ \t]*+(?=([=\]])?)")


def read_bytes(path: Path, what: str, limit: int = -1) -> bytes:
    """The content of a file, or its first `limit` bytes; `what` is how a message calls it ("an arm file").

    Raises UlnaInputError where there is no such file or it cannot be read.
    """
    if "\0" in str(path):
        raise UlnaInputError(f"{str(path)!r}: a path holds no character 0; expected the path of {what}. Correct it.")
    check_path(path)
    try:
        with path.open("rb") as stream:
            return stream.read(limit)
    except FileNotFoundError:
        raise UlnaInputError(f"{path}: no such file; expected {what}. Check the path.{_beside(path)}") from None
    except IsADirectoryError:
        raise UlnaInputError(f"{path}: this is a folder; expected {what}. Name the file in it.") from None
    except OSError as error:
        reason = error.strerror or str(error)
        raise UlnaInputError(f"{path}: cannot be read ({reason}); expected {what}. Check its permissions.") from None


def _beside(path: Path) -> str:
    """The nearest file name in the same folder, for a slip of the finger."""
    try:
        names = [entry.name for entry in path.parent.iterdir() if entry.is_file()]
    except OSError:
        return f" The folder {path.parent} does not exist either." if not path.parent.exists() else ""
    hint = nearest(path.name, names)
    return hint if "Did you mean" in hint else ""


def sha256(content: bytes) -> str:
    """Hexadecimal SHA-256."""
    return hashlib.sha256(content).hexdigest()


def read_toml(path: Path, what: str) -> tuple[dict[str, Any], str]:
    """A TOML document and the file's SHA-256. A byte-order mark and Windows line ends are fine."""
    content = read_bytes(path, what, MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise UlnaInputError(f"{path}: more than {MOST_BYTES >> 20} MB, too large; expected {what}. Check the path.")
    text = _text(content, path, what)
    if not text.strip():
        raise UlnaInputError(f"{path}: the file is empty; expected {what}.")
    _check_steps(text, path, what)
    try:
        document = tomllib.loads(text)
        _check_sizes(document, "", path)
        return document, sha256(content)
    except tomllib.TOMLDecodeError as error:
        raise UlnaInputError(f"{path}: not valid TOML: {error}. Expected {what}; correct that place.") from None
    except (RecursionError, ValueError) as error:
        raise UlnaInputError(_beyond(path, error, what)) from None


def _check_steps(text: str, path: Path, what: str) -> None:
    """Keys with points are few, and their points too: what reads them takes memory with the square of these. Raises
    UlnaInputError."""
    count = text.count("\n[")
    for match in _STEPS.finditer(text):
        if match[1] is None:
            continue  # a number, or words of a text
        steps = match[0].count(".") + 1
        if steps > MOST_STEPS and not re.fullmatch(rf"{_PART}(?:\s*\.\s*{_PART}){{0,{MOST_STEPS - 1}}}\s*", match[0]):
            line = text.count("\n", 0, match.start()) + 1
            raise UlnaInputError(
                f"{path}: line {line}: the key '{match[0][:40]}…' has {steps} names with points between; expected "
                f"{MOST_STEPS} at most, in {what}. Correct it."
            )
        count += steps
    if count > MOST_TABLES:
        raise UlnaInputError(
            f"{path}: more than {MOST_TABLES} tables, too many for a file written by hand; expected {what}. Check the "
            "path."
        )


def _check_sizes(value: Any, key: str, path: Path) -> None:
    """No number is larger than any quantity is: squares of it would be none. Raises UlnaInputError naming the key."""
    if isinstance(value, dict):
        for name, each in value.items():
            _check_sizes(each, f"{key}.{name}" if key else name, path)
    elif isinstance(value, list):
        for number, each in enumerate(value, start=1):
            _check_sizes(each, f"{key}.{number}", path)
    elif isinstance(value, float) and MOST < abs(value) < math.inf:
        raise UlnaInputError(
            f"{path}: key '{key[:80]}': got {value:g}, more than any quantity is; expected a number up to {MOST:g} in "
            "size. Correct it."
        )


def read_json(path: Path, what: str) -> tuple[dict[str, Any], str]:
    """A JSON object and the file's SHA-256."""
    content = read_bytes(path, what)
    text = _text(content, path, what)
    if not text.strip():
        raise UlnaInputError(f"{path}: the file is empty; expected {what}.")
    try:
        document = json.loads(text, parse_constant=_no_number)
    except json.JSONDecodeError as error:
        raise UlnaInputError(
            f"{path}: not valid JSON: {error.msg} (at line {error.lineno}, column {error.colno}). Expected {what}."
        ) from None
    except (RecursionError, ValueError) as error:
        raise UlnaInputError(_beyond(path, error, what)) from None
    if _HALF.search(text):
        _check_letters(document, path, what)
    if not isinstance(document, dict):
        kind = _KINDS.get(type(document), "a number")
        raise UlnaInputError(f"{path}: the document is {kind}; expected an object: {what}. Name the right file.")
    return document, sha256(content)


_HALF = re.compile(r"\\u[dD][89a-fA-F]")
"""How JSON writes half of a character of two; a whole one has both."""


def _check_letters(document: Any, path: Path, what: str) -> None:
    """No text holds half a character, which nobody can write down. Raises UlnaInputError."""
    try:
        json.dumps(document, ensure_ascii=False).encode()
    except UnicodeEncodeError as error:
        half = error.object[error.start].encode("unicode_escape").decode()
        raise UlnaInputError(
            f"{path}: a text holds {half}, half a character; expected {what} as it was written. The file was changed "
            "or damaged: make it again."
        ) from None


_KINDS = {list: "a list", str: "a text", bool: "true or false", type(None): "null"}


def _no_number(constant: str) -> Any:
    raise ValueError(f"{constant} is no number in JSON")


def _beyond(path: Path, error: Exception, what: str) -> str:
    """The document is well-formed, as far as it goes, but no file of ours."""
    reason = str(error)
    if isinstance(error, RecursionError):
        reason = "too many brackets within brackets"
    elif "integer string conversion" in reason:
        reason = "a whole number of thousands of digits"
    return f"{path}: cannot be used: {reason}. Expected {what}; correct that place."


def _text(content: bytes, path: Path, what: str) -> str:
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise UlnaInputError(f"{path}: the file is UTF-16; expected {what} in UTF-8. Save it as UTF-8.")
    try:
        return content.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise UlnaInputError(
            f"{path}: line {line}: the byte 0x{content[error.start]:02x} is not UTF-8; expected {what} as UTF-8 text. "
            "Save it as UTF-8."
        ) from None


def check_format(document: dict[str, Any], path: Path, kind: str, newest: int = 1) -> None:
    """`format` must be `"{kind}/N"` with 1 ≤ N ≤ newest. Raises UlnaInputError."""
    expected = f'format = "{kind}/{newest}"'
    if "format" not in document:
        raise UlnaInputError(
            worded(
                "{file}: key 'format' is missing; expected {expected} as the first line. Add it.",
                file=str(path),
                expected=expected,
            )
        )
    value = document["format"]
    match = re.fullmatch(r"(ulna-[a-z-]+)/([1-9][0-9]{0,8})", value) if isinstance(value, str) else None
    if match is None:
        raise UlnaInputError(
            worded(
                "{file}: key 'format': got {got}, an unknown format; expected {expected}.",
                file=str(path),
                got=repr(value),
                expected=expected,
            )
        )
    if match[1] != kind:
        raise UlnaInputError(
            worded(
                "{file}: key 'format': got '{got}', another kind of file; expected {expected}. Name the right file.",
                file=str(path),
                got=value,
                expected=expected,
            )
        )
    if int(match[2]) > newest:
        raise UlnaInputError(
            worded(
                "{file}: key 'format': version {version} of {kind} is not known to this Ulna; expected {expected} or "
                "older. Update Ulna.",
                file=str(path),
                version=match[2],
                kind=kind,
                expected=expected,
            )
        )
