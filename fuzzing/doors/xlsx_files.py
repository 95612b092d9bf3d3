"""Workbooks."""

from __future__ import annotations

import io
import re
import zipfile
from random import Random
from typing import Any

from fuzzing.cells import Table
from fuzzing.values import Raw, as_date


def xlsx_bytes(table: Table, source: Random) -> bytes:
    """With dates, formulas, errors, merged cells, further sheets and cells beside the table."""
    import openpyxl

    book = openpyxl.Workbook()
    page = book.active
    if source.random() < 0.2:
        page = book.create_sheet(source.choice(["run", "", "a" * 31, "左", "run 1"]), source.choice([0, 1]))
    down, right = source.choice([(0, 0), (0, 0), (0, 0), (1, 0), (3, 2), (0, 1)])
    for y, row in enumerate([table.names, *table.rows], start=1 + down):
        for x, cell in enumerate(row, start=1 + right):
            page.cell(y, x).value = _cell(cell)
    for _ in range(source.choice([0, 0, 1, 2])):
        y, x = source.randrange(1, len(table.rows) + 3), source.randrange(1, len(table.names) + 3)
        way = source.randrange(5)
        if way == 0:
            page.cell(y, x).value = source.choice(["=A1+1", "=1/0", "#N/A", "#DIV/0!", "=B2", '=HYPERLINK("x")'])
        elif way == 1:
            page.merge_cells(
                start_row=y, start_column=x, end_row=y + source.randrange(3), end_column=x + source.randrange(3)
            )
        elif way == 2:
            page.cell(y, x).number_format = source.choice(["yyyy-mm-dd", "0%", "@", "[h]:mm:ss", "General"])
        elif way == 3:
            page.row_dimensions[y].hidden = True
        else:
            page.cell(y, x).value = source.choice([None, True, "", 1e300, -1])
    stream = io.BytesIO()
    book.save(stream)
    return _timeless(stream)


def _timeless(stream: io.BytesIO) -> bytes:
    """The same workbook: its parts, and what they say of themselves, are of no day."""
    written = io.BytesIO()
    with zipfile.ZipFile(stream) as book, zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as copy:
        for name in book.namelist():
            content = book.read(name)
            if name == "docProps/core.xml":
                content = re.sub(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", b"2026-01-01T00:00:00Z", content)
            part = zipfile.ZipInfo(name)  # of 1980
            part.compress_type = zipfile.ZIP_DEFLATED
            copy.writestr(part, content)
    return written.getvalue()


def _cell(cell: Any) -> Any:
    if isinstance(cell, Raw):
        try:
            return as_date(cell)
        except ValueError:
            return str(cell)
    return str(cell) if isinstance(cell, list | dict) else cell
