"""Tables as text."""

from __future__ import annotations

from random import Random

from fuzzing.bites import spoilt_text
from fuzzing.cells import Table


def csv_bytes(table: Table, source: Random) -> bytes:
    """With quotes where they belong, or not; other separators, line ends, encodings; lines that are no readings."""
    separator = source.choice([",", ",", ",", ",", ";", "\t", " ", "|"])
    end = source.choice(["\n", "\n", "\n", "\r\n", "\r", "\n\n"])
    lines = [separator.join(_cell(cell, separator, source) for cell in row) for row in [table.names, *table.rows]]
    for _ in range(source.choice([0, 0, 0, 1, 2])):
        lines.insert(source.randrange(len(lines) + 1), source.choice(_LINES))
    text = end.join(lines) + source.choice([end, end, "", end * 3, "\x1a", "\x00\x00"])
    encoding = source.choice(_ENCODINGS)
    content = text.encode(encoding, "surrogatepass" if encoding.startswith("utf") else "replace")
    return spoilt_text(content, source) if source.random() < 0.2 else content


def _cell(cell: object, separator: str, source: Random) -> str:
    text = "" if cell is None else str(cell)
    way = source.random()
    if way < 0.02:
        return source.choice(['"', '""', '"""', f'"{text}', f'{text}"', f'"{text}"x', f" {text} ", f'{text}""'])
    if separator in text or '"' in text or "\n" in text or way < 0.04:
        return '"' + text.replace('"', '""') + '"' if source.random() < 0.8 else text
    return text


_LINES = (
    "",
    " ",
    ",,,,",
    "# a comment",
    "sep=;",
    '"',
    '""',
    "mm,mm,rad",
    ";;;;",
    "End of file",
    "1",
    "1,2,3",
    "\t",
    "%",
    "a,b",
    ",".join(["1"] * 200),
    "x" * 5000,
    "placement,feature,q1,q2,q3,q4,temperature,id",
)
_ENCODINGS = ("utf-8", "utf-8", "utf-8", "utf-8", "utf-8-sig", "utf-16", "utf-16-le", "latin-1", "gbk", "utf-32")
