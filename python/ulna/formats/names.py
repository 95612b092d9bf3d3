"""Names that a user gives: which can be parts of parameter names and cells of a table."""

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
