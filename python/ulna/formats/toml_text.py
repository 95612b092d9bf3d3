"""Keys and values as TOML writes them; numbers come back exactly as they were.

Not tomlkit: it writes the same numbers, but inline tables as {a = 1} where files and documentation have { a = 1 }, and
what it is for, changing a file that somebody wrote and keeping the rest, Ulna never does. tomllib reads all this back.
"""

from __future__ import annotations

import re
from numbers import Integral
from typing import Any


def toml_key(name: str) -> str:
    """A key as TOML writes it."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else toml_value(name)


def toml_value(value: Any) -> str:
    """A text, a number, a truth value, a list or a table of these. Raises TypeError for anything else."""
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return '"' + re.sub(r"[\x00-\x1f\x7f]", lambda match: f"\\u{ord(match[0]):04x}", escaped) + '"'
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{toml_key(key)} = {toml_value(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(toml_value(inner) for inner in value) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return repr(float(value))  # of NumPy's too, which call themselves by their type
    if isinstance(value, Integral):
        return repr(int(value))
    raise TypeError(f"{value!r}: no value of a TOML file; expected a text, a number, true or false, a list or a table")
