"""Where data rows stand in their file, as the program that shows the file counts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Places:
    """Of the rows of one table."""

    name: str
    """With `{}` for the line: "line {}" of a text, "Messung!A{}" of a sheet."""
    lines: Sequence[int] | int
    """Line of each row; or how many lines stand above the first, where rows follow each other."""

    def of(self, row: int) -> str:
        """The place of a data row, counted from 1."""
        return self.name.replace("{}", str(row + self.lines if isinstance(self.lines, int) else self.lines[row - 1]))
