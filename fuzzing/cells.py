"""Tables of readings spoilt: cells, rows, columns, names. How they are written is each format's own."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random
from typing import Any

from fuzzing.room import READINGS
from fuzzing.values import any_value, number, text


@dataclass
class Table:
    """Names, and rows of cells: numbers, texts, and what else a program may have put there."""

    names: list[str]
    rows: list[list[Any]]

    @classmethod
    def plain(cls) -> Table:
        """The readings that all of these are made of."""
        head, *rows = READINGS.splitlines()
        return cls(head.split(","), [[_value(cell) for cell in row.split(",")] for row in rows])

    def columns(self) -> list[list[Any]]:
        """By column; short rows end in None."""
        return [[row[k] if k < len(row) else None for row in self.rows] for k in range(len(self.names))]


def _value(cell: str) -> Any:
    for kind in (int, float):
        try:
            return kind(cell)
        except ValueError:
            continue
    return cell


def spoilt_table(source: Random) -> Table:
    """With one to four things wrong, or none."""
    table = Table.plain()
    for _ in range(source.choice([0, 1, 1, 2, 4])):
        at = source.randrange(len(table.rows)) if table.rows else 0
        k = source.randrange(len(table.names)) if table.names else 0
        way = source.randrange(13)
        if way <= 4 and table.rows and k < len(table.rows[at]):
            table.rows[at][k] = source.choice([number, number, text, any_value])(source)
        elif way == 5 and table.names:
            name = table.names[k]
            table.names[k] = source.choice(
                [text(source), name.upper(), name + " ", source.choice(table.names), "", "q5"]
            )
        elif way == 6 and table.rows:
            del table.rows[at]
        elif way == 7 and table.rows:
            table.rows.insert(at, list(table.rows[at]))
        elif way == 8 and table.rows:
            table.rows[at] = table.rows[at][:k]
        elif way == 9 and table.rows:
            table.rows[at] = [*table.rows[at], any_value(source)]
        elif way == 10:
            filling = source.choice([None, "", 0, "x", True, 1e300, [1, 2]])
            for row in table.rows:
                row[k : k + 1] = [filling]
        elif way == 11 and len(table.names) > 1:
            del table.names[k]
            for row in table.rows:
                del row[k : k + 1]
        else:
            table.rows = source.choice([[], table.rows * 60, table.rows[:1], table.rows[::-1]])
    return table
