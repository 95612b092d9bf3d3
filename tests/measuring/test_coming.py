"""`ulna measure -`: each row is measured and written as it comes, in bounded memory, and told where it is bad."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import platinum

from ulna.formats.layout import Layout
from ulna.formats.tables.coming import coming_table
from ulna.ground.errors import UlnaInputError
from ulna.measuring.job import MeasureJob
from ulna.measuring.measure import measure_to_stream

Q = np.random.default_rng(5).uniform(-3, 3, (60, 7)).round(9)
HEAD = "id," + ",".join(f"q{k}" for k in range(1, 8))
ROWS = [f"n{k}," + ",".join(map(repr, row)) for k, row in enumerate(Q.tolist())]
TEXT = "\n".join([HEAD, *ROWS]) + "\n"


class Pipe:
    """What comes in pieces."""

    def __init__(self, pieces: list[bytes]) -> None:
        self.pieces = pieces

    def read1(self, size: int) -> bytes:
        return self.pieces.pop(0) if self.pieces else b""


def measured(pieces: list[bytes], **layout: Any) -> tuple[bytes, str]:
    """What goes out, and the message where the pipe's table cannot be used."""
    out = io.BytesIO()
    try:
        table = coming_table(Pipe(pieces), "readings", Layout.of_options(**layout))  # type: ignore[arg-type]
        measure_to_stream(MeasureJob(platinum(), table, layout=Layout.of_options(**layout)), out)
    except UlnaInputError as error:
        return out.getvalue(), str(error)
    return out.getvalue(), ""


def of_file(tmp_path: Path, text: str, **layout: Any) -> bytes:
    (tmp_path / "r.csv").write_text(text)
    out = io.BytesIO()
    measure_to_stream(MeasureJob(platinum(), tmp_path / "r.csv", layout=Layout.of_options(**layout)), out)
    return out.getvalue()


@pytest.mark.parametrize("size", [1, 7, 100, 10**6])
def test_the_points_are_those_of_the_file_however_it_comes(tmp_path: Path, size: int) -> None:
    text = TEXT.encode()
    pieces = [text[at : at + size] for at in range(0, len(text), size)]
    assert measured(pieces) == (of_file(tmp_path, TEXT), "")


def test_dialects(tmp_path: Path) -> None:
    german = TEXT.replace(",", ";").replace(".", ",")
    how: Any = {"separator": ";", "decimal": ","}
    assert measured([german.encode()], **how) == (of_file(tmp_path, TEXT), "")
    windows = "\ufeff" + TEXT.replace("\n", "\r\n").rstrip()
    assert measured([windows.encode()]) == (of_file(tmp_path, TEXT), "")
    commented = TEXT.replace("\n", "\n# a remark\n")
    assert measured([commented.encode()], comment="#") == (of_file(tmp_path, TEXT), "")
    units = TEXT.replace("\n", "\n,rad,rad,rad,rad,rad,rad,rad\n", 1)
    assert measured([units.encode()]) == (of_file(tmp_path, TEXT), "")
    nameless = TEXT.partition("\n")[2]
    columns = {"id": "c1"} | {f"q{k}": f"c{k + 1}" for k in range(1, 8)}
    assert measured([nameless.encode()], header=False, columns=columns) == (of_file(tmp_path, TEXT), "")
    assert measured([("title\n" + TEXT).encode()], header=2) == (of_file(tmp_path, TEXT), "")


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("n9,1,2,3,4,5,6,x", r"row 3 (line 4), column 'q7': got 'x', expected a number"),
        ("n9,1,2,3,4,5,6,", r"row 3 (line 4), column 'q7': the cell is empty"),
        ("n9,1,2,3,4,5,6,inf", r"row 3 (line 4), column 'q7': got 'inf', expected a finite number"),
        ("n9,1,2,3,4,5,6", r"row 3 (line 4) has 7 cells, expected 8"),
        (",1,2,3,4,5,6,7", r"row 3 (line 4), column 'id': the cell is empty; expected a name"),
        ('n9,1,2,3,4,5,6,"7', r"a quotation mark is opened and not closed on its line"),
        ("", r"line 4 is blank"),
        ("n9,99,2,3,4,5,6,7", r"row 3 (line 4), column 'q1': got 99 rad, more than two turns"),
    ],
)
def test_a_bad_row_is_named_and_those_before_it_were_good(line: str, expected: str) -> None:
    good, _ = measured(["\n".join([HEAD, *ROWS[:2]]).encode()])
    found, message = measured([f"{part}\n".encode() for part in [HEAD, *ROWS[:2], line, *ROWS[2:]]])
    assert expected in message
    assert "standard input" in message
    assert "\n" not in message
    assert found == good


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"", "it is empty"),
        (b"PAR1" + bytes(100), "this is a Parquet file, which has to be read whole"),
        (b"PK\x03\x04" + bytes(100), "this is an Excel workbook"),
        (HEAD.encode() + b"\n" + b"\xe4,1,2,3,4,5,6,7\n", "line 2: the byte 0xe4 is no utf-8 text"),
        (HEAD.encode() + b"\n", "no rows"),
        (HEAD.replace(",", ";").encode() + b"\n", "separated by semicolons"),
        (b"x" * (3 << 20), "does not end within 1 MB"),
        (b"id,q1,q2\nn,1,2\n", "'q3' is missing"),
    ],
)
def test_what_cannot_come_is_told(content: bytes, expected: str) -> None:
    found, message = measured([content[at : at + 65536] for at in range(0, len(content), 65536)])
    assert expected in message
    assert found == b""


def test_an_encoding_whose_lines_cannot_be_told_apart() -> None:
    _, message = measured([TEXT.encode("utf-16")], encoding="utf-16")
    assert "--encoding: got 'utf-16'" in message


def start(tmp_path: Path, *more: str) -> subprocess.Popen[bytes]:
    platinum().save(tmp_path / "arm.toml", force=True)
    return subprocess.Popen(
        [sys.executable, "-m", "ulna", "measure", str(tmp_path / "arm.toml"), "-", *more],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=os.environ | {"COLUMNS": "80"},
        bufsize=0,
    )


def test_a_point_comes_before_the_next_reading_is_given(tmp_path: Path) -> None:
    """Question and answer: were a row held back, this would wait for ever."""
    with start(tmp_path) as program:
        assert program.stdin is not None
        assert program.stdout is not None
        program.stdin.write(f"{HEAD}\n".encode())
        for k, row in enumerate(ROWS[:5]):
            program.stdin.write(f"{row}\n".encode())
            program.stdin.flush()
            if k == 0:
                assert program.stdout.readline() == b"id,x,y,z\n"
            name, *xyz = program.stdout.readline().decode().split(",")
            assert name == f"n{k}"
            np.testing.assert_allclose(np.array(xyz, dtype=float), platinum().tip(Q[k]), rtol=0, atol=1e-12)
        program.stdin.close()
        assert program.wait() == 0


def test_a_reader_who_has_seen_enough_is_no_failure(tmp_path: Path) -> None:
    with start(tmp_path) as program:
        assert program.stdin is not None
        assert program.stdout is not None
        assert program.stderr is not None
        program.stdin.write(f"{HEAD}\n{ROWS[0]}\n".encode())
        program.stdin.flush()
        program.stdout.readline()
        program.stdout.close()
        try:
            for row in ROWS * 50:
                program.stdin.write(f"{row}\n".encode())
                program.stdin.flush()
            program.stdin.close()
        except BrokenPipeError:  # it has ended before all was given
            pass
        assert program.wait() == 0
        assert program.stderr.read() == b""


def test_a_bad_row_ends_with_code_2_and_a_file_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    with start(tmp_path, "-o", str(tmp_path / "points.csv")) as program:
        out, message = program.communicate("\n".join([HEAD, *ROWS[:3], "n,1,2,3,4,5,6,x"]).encode())
        assert program.returncode == 2
        assert out == b""
        assert b"row 4 (line 5), column 'q7'" in message
    assert [path.name for path in tmp_path.iterdir()] == ["arm.toml"]
    with start(tmp_path, "-o", str(tmp_path / "points.csv")) as program:
        program.communicate(TEXT.encode())
        assert program.returncode == 0
    assert pl.read_csv(tmp_path / "points.csv").height == 60


def test_memory_does_not_grow_with_the_rows() -> None:
    """What is held at any time are the rows of one piece, however many have come."""
    pieces = (f"{row}\n".encode() for _ in range(50) for row in ROWS)

    head = [f"{HEAD}\n".encode()]

    class Endless:
        def read1(self, size: int) -> bytes:
            return head.pop() if head else next(pieces, b"")

    table = coming_table(Endless(), "readings", Layout())  # type: ignore[arg-type]
    job = MeasureJob(platinum(), table)
    most = 0
    for frame in job.frames():
        most = max(most, len(frame), len(table.place))
    assert job.rows == 3000
    assert most == 1
