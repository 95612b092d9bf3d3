"""Documents as text, with values in them that the languages have no word for."""

from __future__ import annotations

import datetime
import json
import re
from typing import Any

from fuzzing.values import Raw


def json_text(value: Any) -> bytes:
    """JSON; NaN and infinity as Python writes them, which is no JSON."""
    return _json(value).encode("utf-8", "surrogatepass")


def _json(value: Any) -> str:
    if isinstance(value, Raw):
        return str(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(str(name))}: {_json(each)}" for name, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_json, value)) + "]"
    return json.dumps(value, default=str)


def toml_text(document: Any) -> bytes:
    """TOML, each key of the top on a line of its own; None as a word that it does not know."""
    if not isinstance(document, dict):
        return _toml(document).encode("utf-8", "surrogatepass")
    lines = [f"{_key(name)} = {_toml(value)}\n" for name, value in document.items()]
    return "".join(lines).encode("utf-8", "surrogatepass")


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _quoted(name)


def _quoted(value: str) -> str:
    # JSON's escapes are TOML's, but for surrogates: those of other planes would be a pair
    plain = json.dumps(value, ensure_ascii=False)
    return plain.replace("\x7f", "\\u007f")


def _toml(value: Any) -> str:
    if isinstance(value, Raw):
        return str(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float) and value != value:
        return "nan"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(str(name))} = {_toml(each)}" for name, each in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    if isinstance(value, datetime.date | datetime.time):
        return value.isoformat()
    return _quoted(value) if isinstance(value, str) else str(value)
