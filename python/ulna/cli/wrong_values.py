"""A value that no option can be: said as all else is, and not in the words of the library that found out."""

from __future__ import annotations

import re
from typing import Any

_EXPECTED = {
    "int_parsing": "a whole number",
    "int_from_float": "a whole number",
    "int_type": "a whole number",
    "int_parsing_size": "a whole number that is shorter",
    "float_parsing": "a number",
    "float_type": "a number",
    "finite_number": "a finite number",
    "bool_parsing": "true or false",
}
_LIMITS = {"ge": "a number of at least {:g}", "gt": "a number greater than {:g}", "le": "a number of at most {:g}"}


def in_words(error: Any) -> None:
    """Puts the message of a wrong parameter into Ulna's words, where Pydantic has found it."""
    found = getattr(error.__cause__, "errors", None)
    if found is None:
        return
    detail = found(include_url=False)[0]
    context = detail.get("ctx", {})
    limits = [text.format(context[name]) for name, text in _LIMITS.items() if name in context]
    said = re.sub(r"^Input should be (a valid )?|, unable to .*", "", detail["msg"])
    expected = limits[0] if limits else _EXPECTED.get(detail["type"], said)
    error.message = f"got {str(detail['input'])[:60]!r}, expected {expected}. Correct it."
