"""No table gives a number that is larger than any quantity is: squares of it would be none, and `inf` be printed."""

from __future__ import annotations

import io
import re
import tempfile
import tomllib
from pathlib import Path

import polars as pl
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.cli_runs import run
from tests.foreign_tables import WRITERS
from tests.small_study import SmallStudy

from ulna.formats.header import Header
from ulna.formats.layout import AS_EXPECTED, Layout
from ulna.formats.spelling import MOST
from ulna.formats.table import read_header, read_table, stream
from ulna.formats.tables.coming import coming_table
from ulna.formats.tables.frame import frame_table
from ulna.ground.errors import UlnaInputError

NUMBERS = ("q1", "q2")
Sizes = st.floats(1e-3, 1.7e308) | st.sampled_from([MOST, 1.00001 * MOST, 1e300])
"""None nearer to the limit: a workbook keeps 16 digits."""


def table(value: float, row: int) -> pl.DataFrame:
    """Four rows; q2 of one (from 1) is the value."""
    rows = [0.5, 0.25, 1.5, 2.5]
    rows[row - 1] = value
    return pl.DataFrame({"q1": [0.125, 1.0, 2.0, 3.0], "q2": rows, "feature": list("ABAB")})


def check(header: Header, value: float, row: int, piecewise: bool) -> None:
    """It is read as it is, or refused by its place, itself and what was expected."""

    def read() -> list[float]:
        if not piecewise:
            return read_table(header, NUMBERS.__contains__, [*NUMBERS, "feature"])["q2"].to_list()
        return [x for piece in stream(header, NUMBERS, ["feature"]) for x in piece.numbers[:, 1].tolist()]

    if abs(value) <= MOST:
        assert read() == pytest.approx(table(value, row)["q2"].to_list(), rel=1e-14)
        return
    with pytest.raises(UlnaInputError, match=r"more than any quantity is; expected a number up to 1e\+15 in size") as e:
        read()
    place, got = re.fullmatch(r".*?row (\d+)\b.*column '\w+'.*: got '([^']*)', more.*", str(e.value)).groups()  # type: ignore[union-attr]
    assert int(place) == row
    assert float(got.replace(",", ".")) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize("piecewise", [False, True])
@pytest.mark.parametrize("name", WRITERS)
@settings(max_examples=10, deadline=None)
@given(size=Sizes, sign=st.sampled_from([-1.0, 1.0]), row=st.integers(1, 4))
def test_of_every_format(name: str, piecewise: bool, size: float, sign: float, row: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        keys = tomllib.loads(WRITERS[name](table(sign * size, row), path))
        header = read_header(path, layout=Layout.of_options(**keys), known=(*NUMBERS, "feature"))
        check(header, sign * size, row, piecewise)


@settings(deadline=None)
@given(size=Sizes, sign=st.sampled_from([-1.0, 1.0]), row=st.integers(1, 4))
def test_of_what_comes_and_what_is_in_memory(size: float, sign: float, row: int) -> None:
    frame = table(sign * size, row)
    check(coming_table(io.BytesIO(frame.write_csv().encode()), "readings", AS_EXPECTED), sign * size, row, True)
    for piecewise in (False, True):
        check(frame_table(frame, "readings", AS_EXPECTED), sign * size, row, piecewise)


def test_a_command_says_so(tmp_path: Path) -> None:
    SmallStudy(tmp_path)
    bars = (tmp_path / "bars.csv").read_text().splitlines()
    name, row = bars[0].split(","), bars[2].split(",")
    row[name.index("q2")] = "1e300"
    (tmp_path / "bars.csv").write_text("\n".join([*bars[:2], ",".join(row), *bars[3:]]))
    done = run("identify", tmp_path / "study.toml")
    assert done.returncode == 2
    assert "row 2 (line 3 of the file), column 'q2': got '1e300', more than any quantity is" in done.stderr
