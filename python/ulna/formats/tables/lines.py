"""Texts as people keep them, read whole: other encodings and line ends, titles, units, comments, Excel's `sep=`.

A file that is written plainly never comes here: `untidy` looks through its bytes once.
"""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import polars as pl

from ulna.formats.cells import minutes_said, text_cell, wrong_count
from ulna.formats.encodings import decoded, utf16
from ulna.formats.header import MOST_CELLS, Numeric, refused
from ulna.formats.layout import AS_EXPECTED, Layout
from ulna.formats.places import Places
from ulna.formats.spelling import sexagesimal
from ulna.formats.tables.grid import GridTable, lay_out
from ulna.formats.tables.heads import Grid, is_blank
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded

_KEYS = ("thousands", "encoding", "comment", "units_row", "fill_down")
_CHUNK = 1 << 22
_BLANK = re.compile(rb"\n[ \t,;]*\r?\n[ \t,;\r\n]*[^ \t,;\r\n\x00\x1a]")
_SEP = re.compile(r'"?sep=(.)"?,*$', re.IGNORECASE)
_MOST_BYTES = 1 << 29


@dataclass(frozen=True)
class LineTable(GridTable):
    """A text as rows of cells."""

    layout: Layout = AS_EXPECTED
    separator: str = ","

    @property
    def head(self) -> str:
        return f"line {self.header_line}" if self.header_line else "line 1"

    def where(self, row: int) -> str:
        return f"row {row} (line {self.lines[row - 1]} of the file)"

    @property
    def row_places(self) -> Places:
        return Places("line {}", self.lines)

    def cells(self, numeric: Numeric, columns: Sequence[str]) -> pl.DataFrame:
        self._check_counts()
        found = []
        for name in columns:
            texts = [str(value) for value in self.values(name)]
            if numeric(name):
                number = self.layout.spelling.number
                found.append(pl.Series(name, [number(text) for text in texts], dtype=pl.Float64))
            else:
                found.append(pl.Series(name, [text.strip() or None for text in texts], dtype=pl.String))
        return pl.DataFrame(found)

    def numbers(self, texts: pl.Series) -> pl.Series:
        number = self.layout.spelling.number
        values = [None if text is None else number(text) for text in texts]
        return pl.Series(texts.name, values, dtype=pl.Float64)

    def refusal(self, row: int, column: str, numeric: Numeric) -> str:
        no_header = self.header_line is None and row == 1
        return text_cell(self, row, column, str(self.value(row, column)), numeric, self.layout, no_header)

    def _check_counts(self) -> None:
        """Every row has a cell for each column. Raises UlnaInputError for those that do not."""
        width = self.places[-1] + 1 if self.places else 0
        told: list[str] = []
        count = 0
        for row, cells in enumerate(self.grid, start=1):
            if len(cells) < width or not all(map(is_blank, cells[width:])):
                count += 1
                if len(told) < MOST_CELLS:
                    told.append(wrong_count(self, row, cells, width, self.separator, self.header_line is not None))
        if told:
            raise refused(self, told, count)


def untidy(path: Path, start: bytes, layout: Layout) -> bool:
    """Whether a text needs to be read here: because the study says so of it, or because its bytes do."""
    first, _, rest = start.removeprefix(b"\xef\xbb\xbf").partition(b"\n")
    if layout.separator == " " or layout.header not in (True, False) or any(key in layout.given for key in _KEYS):
        return True
    if utf16(start) is not None or b"\x00" in start or b"\r" in first.rstrip(b"\r") or not first.strip():
        return True
    separator = (layout.separator or ",").encode()
    if layout.header is not False and _strange_beginning(first, rest, separator):
        return True
    return path.stat().st_size <= _MOST_BYTES and _strange_bytes(path, separator)


def _strange_beginning(first: bytes, rest: bytes, separator: bytes) -> bool:
    """Whether the first line names no columns, or the second is no reading."""
    line = first.strip(b"\r \t")
    if line[:1] in (b"#", b"%", b"!") or line.lower().lstrip(b'"').startswith(b"sep="):
        return True
    if b'"' not in line and not all(name.strip() for name in line.split(separator)):
        return True
    cells, below = line.split(separator), rest.split(b"\n", 12)[:12]
    if b'"' not in rest[:4096] and any(len(each.split(separator)) > len(cells) for each in below[:-1] if each.strip()):
        return True
    second = below[0] if below else b""
    return bool(second.strip()) and not any(chr(byte).isdigit() for byte in second)


def _strange_bytes(path: Path, separator: bytes) -> bool:
    """Whether somewhere there are blank lines within, quotes that do not close in their line, letters that are no
    UTF-8, or a last line that is no reading."""
    carried = tail = b""
    with path.open("rb") as stream:
        head = stream.readline()
        stream.seek(0)
        while chunk := stream.read(_CHUNK):
            whole, newline, carry = (carried + chunk).rpartition(b"\n")
            piece, carried = (whole + newline, carry) if newline else (carry, b"")
            if _BLANK.search(tail + piece) or b"\x00" in piece or b"\x1a" in piece:
                return True
            if b'"' in piece and any(line.count(b'"') & 1 for line in piece.split(b"\n")):
                return True
            if not piece.isascii() and not _is_utf8(piece):
                return True
            tail = (tail + piece)[-256:]
        if b'"' in carried and carried.count(b'"') & 1:
            return True
        if not _is_utf8(carried) or _BLANK.search(tail + carried) or b"\x00" in carried or b"\x1a" in carried:
            return True
    last = (tail + carried).rstrip().rpartition(b"\n")[2]
    return separator in head and separator not in last and not any(chr(byte).isdigit() for byte in last)


def _is_utf8(content: bytes) -> bool:
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return True


def open_lines(path: Path, what: str, layout: Layout) -> LineTable:
    """A text by all of its bytes. Raises UlnaInputError for what is not written as the layout says."""
    content = path.read_bytes()
    remarks: list[str] = []
    text, encoding = decoded(path, content, what, layout.encoding, layout.say("encoding", "cp1252"))
    if encoding is not None:
        shown = next(
            (f", such as '{cell.strip()[:24]}'" for cell in re.split(r"[,;\t\r\n|]", text) if not cell.isascii()), ""
        )
        key, read = layout.say("encoding", "…"), f"{encoding}{shown}"
        remarks.append(worded("read as {encoding}; say {key} where that is wrong.", encoding=read, key=key))
    text = _stripped(path, text, what, remarks)
    lines = re.split(r"\r\n|\r|\n", text)
    begin = 0
    separator = layout.separator
    said = _SEP.match(lines[0].strip())
    if said:
        begin = 1
        if separator is None:
            separator = said[1]
            remarks.append(worded("line 1 says that '{separator}' stands between columns.", separator=separator))
        elif separator != said[1]:
            raise UlnaInputError(
                f"{layout.key('separator')}: got '{separator}', but line 1 of {path} says '{lines[0].strip()}'; "
                "expected the same. Correct one of them."
            )
    separator = separator or ","
    grid, places = _records(path, lines, begin, separator, what)
    if not grid:
        raise UlnaInputError(f"{path}: there are no lines; expected {what}.")

    def cell_name(line: int, k: int) -> str:
        return f"line {line}, column {k + 1}"

    laid = lay_out(path, grid, places, layout, "line {}".format, cell_name, ragged=False)
    return LineTable(
        path,
        laid.names,
        what=what,
        lines=laid.lines,
        grid=laid.grid,
        places=laid.places,
        header_line=laid.header_line,
        units=laid.units,
        remarks=[worded("{of}: {why}", of=str(path), why=remark) for remark in [*remarks, *laid.remarks]],
        layout=layout,
        separator=separator,
    )


def _stripped(path: Path, text: str, what: str, remarks: list[str]) -> str:
    """Without what old programs write behind a text: Ctrl-Z, zeros to the end of a block."""
    bare = text.rstrip("\x00\x1a\r\n \t")
    blanks = re.match(r"[ \t]*", text[len(bare) :])
    bare += blanks[0] if blanks else ""  # tabs behind the last cell stand before empty ones
    if len(text) > len(bare) and any(sign in text[len(bare) :] for sign in "\x00\x1a"):
        remarks.append(worded("the signs behind the last line (Ctrl-Z, zeros) are not read."))
    if "\x00" in bare:
        raise UlnaInputError(f"{path}: the file is binary; expected {what}.")
    return bare


def _records(path: Path, lines: list[str], begin: int, separator: str, what: str) -> tuple[Grid, list[int]]:
    """The cells of each record, and the line on which it begins. Raises UlnaInputError for a quotation mark that nobody
    closes: the lines behind it would be lost."""
    if separator == " ":
        lines = [re.sub(r"[ \t]+", " ", line.strip()) for line in lines]
    counts = Counter(line.count(separator) for line in lines[begin : begin + 1000])
    usual = max(counts, key=lambda count: (count > 0, counts[count]), default=0)
    reader = csv.reader(io.StringIO("\n".join(lines[begin:]), newline=""), delimiter=separator, skipinitialspace=True)
    grid: Grid = []
    places: list[int] = []
    before = begin
    try:
        for cells in reader:
            first, last = before + 1, begin + reader.line_num
            before = last
            grid.append(cells)
            places.append(first)
            if last > first or (last == len(lines) and sum(line.count('"') for line in lines[first - 1 :]) % 2):
                _check_quotes(path, lines, first, last, separator, usual, what)
    except csv.Error as error:
        why = "a quotation mark is not closed" if "field limit" in str(error) else str(error)
        raise UlnaInputError(f"{path}: line {before + 1}: {why}; expected {what}. Correct it.") from None
    return grid, places


def _check_quotes(path: Path, lines: list[str], first: int, last: int, separator: str, usual: int, what: str) -> None:
    """A cell may run over lines; but what would be a row by itself is one. Raises UlnaInputError."""
    inside = lines[first:last]
    odd = sum(line.count('"') for line in lines[first - 1 : last]) % 2
    if odd or any(usual and line.count(separator) >= usual for line in inside):
        degrees = sexagesimal(lines[first - 1])
        if degrees is not None:
            raise UlnaInputError(f"{path}: line {first}: angles in {minutes_said(degrees)}")
        until = f"line {last}" if not odd else "the end of the file"
        raise UlnaInputError(
            f"{path}: line {first}: a quotation mark is opened and not closed before {until}, so that what stands "
            f"between would be one cell: '{lines[first - 1][:60]}'; expected {what}. Close or remove it."
        )
