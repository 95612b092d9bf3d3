"""Names that a user gives: which can be parts of parameter names and cells of a table, and which of files."""

from __future__ import annotations

import re
from pathlib import Path

from ulna.ground.errors import UlnaInputError


def check_name(name: str, key: str, path: Path) -> None:
    """Names become parts of parameter names and cells of a CSV. Raises UlnaInputError."""
    if not name.strip() or name != name.strip() or re.search(r'[.*?\[\],"/\\\x00-\x1f]', name):
        raise UlnaInputError(
            f"{path}: key '{key}': the name {name!r} cannot be used; expected letters, digits, '-', '_' or inner "
            'spaces (no . , * ? [ ] / \\ "). Rename it.'
        )


def as_text(name: str) -> str:
    """A name out of a file system; bytes that are no UTF-8 are written out."""
    return name.encode(errors="surrogateescape").decode(errors="backslashreplace")


def check_path(path: Path) -> None:
    """Results name what they were made of, and texts are UTF-8. Raises UlnaInputError for a place whose name is not."""
    name = str(path.absolute())
    try:
        name.encode()
    except UnicodeEncodeError:
        raise UlnaInputError(
            f"{as_text(name)}: the name is not UTF-8, so that no result can say it; expected one that is. Rename it."
        ) from None
