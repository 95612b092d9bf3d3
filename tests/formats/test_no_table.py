"""What is no table is told in one sentence, whatever it is given for; what is a table never is."""

from __future__ import annotations

import gzip
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.cli_runs import assert_bad_input, platinum, run

from ulna.formats.no_table import is_prose
from ulna.formats.table import read_header
from ulna.ground.errors import UlnaInputError

FILES = {
    "a PDF document": b"%PDF-1.7\n%\xe2\xe3\xcf\xd3\n1 0 obj\n",
    "a picture": b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR",
    "a packed file": gzip.compress(b"q1,q2\n1.5,2.5\n"),
    "a web page (HTML)": b"<!DOCTYPE html>\n<html><body><table><tr><td>q1</td></tr></table></body></html>\n",
    "a robot's description (URDF)": b'<?xml version="1.0"?>\n<robot name="a">\n <link name="b"/>\n</robot>\n',
    "an XML file": b'<?xml version="1.0"?>\n<data><q1>1.5</q1></data>\n',
    "a JSON file": b'\xef\xbb\xbf{\n "q1": [1.5, 2.5],\n "q2": [3.5, 4.5]\n}\n',
    "a LaTeX document": b"\\documentclass{article}\n\\begin{document}\n1, 2\n\\end{document}\n",
    "a page in Markdown": b"# Readings\n\nThe **arm** has turns:\n\n| q1 | q2 |\n|---|---|\n| 1.5 | 2.5 |\n",
    "a file of Ulna's own (TOML)": b'# mine\nformat = "ulna-arm/1"\nname = "a, b"\n[[joint]]\na = 1.5\n',
    "a text without rows of numbers": b"Dear all,\nthe readings of the 3 arms are below, see there.\nRegards, A.\n",
}


@pytest.mark.parametrize("what", FILES)
def test_a_file_of_another_kind_is_told_in_one_sentence(tmp_path: Path, what: str) -> None:
    path = tmp_path / "readings.csv"
    path.write_bytes(FILES[what])
    with pytest.raises(UlnaInputError) as told:
        read_header(path, "a readings file", known=["q1", "q2"])
    said = str(told.value)
    assert f"readings.csv: this is {what}" in said
    assert "and no table; expected a readings file." in said
    assert "such places" not in said
    assert "line" not in said.replace("rows", "")


@pytest.mark.parametrize("command", ["measure", "new", "import dh"])
def test_every_command_says_it(tmp_path: Path, command: str) -> None:
    platinum().save(tmp_path / "arm.toml")
    path = tmp_path / "README.md"
    path.write_bytes(FILES["a page in Markdown"])
    arguments = {
        "measure": ["measure", tmp_path / "arm.toml", path],
        "new": ["new", "--readings", path, "-o", tmp_path / "study"],
        "import dh": ["import", "dh", path, "-o", tmp_path / "out.toml", "--convention", "dh"],
    }[command]
    assert_bad_input(run(*arguments), "this is a page in Markdown, and no table")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["README.md", "arm.toml"]


number = st.floats(-1e6, 1e6).map(lambda value: f"{value:.6g}")
word = st.text("abcdefgh ÄÖ°", min_size=1, max_size=12)


@settings(max_examples=200, deadline=None)
@given(
    st.lists(word, max_size=4),
    st.lists(st.tuples(number, word), min_size=1, max_size=20),
    st.sampled_from([",", ";", "\t"]),
    st.sampled_from(["utf-8", "utf-16", "cp1252"]),
)
def test_a_table_is_no_prose(titles: list[str], rows: list[tuple[str, str]], separator: str, encoding: str) -> None:
    """One column of numbers among words, below titles, in any letters."""
    lines = [*titles, f"q1{separator}remark", *(separator.join(row) for row in rows)]
    assert not is_prose("\n".join(lines).encode(encoding))


def test_bad_cells_below_known_names_are_named_as_ever(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("q1,q2\none,two\nthree,four\n")
    header = read_header(path, known=["q1", "q2"])
    with pytest.raises(UlnaInputError, match=r"row 1 .*column 'q1': got 'one', expected a number"):
        header.frame(lambda _: True, ["q1", "q2"])
