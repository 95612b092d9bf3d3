"""What a file holds goes into messages as something to read: it moves no cursor, and fills no screen."""

from __future__ import annotations

import unicodedata
from pathlib import Path

import pytest
from tests.cli_runs import run
from tests.small_study import STUDY, SmallStudy

from ulna.ground.errors import LONGEST, for_people

NAMES = [
    "\u001b[31mred",
    "\u0007bell",
    "\u009b31m",
    "left\u202eright",
    "a\u0000b",
    "two\nlines",
    "two\rlines",
    "x" * 20_000,
]


@pytest.mark.parametrize("name", NAMES)
def test_a_name_out_of_a_file(name: str, tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    written = "".join(f"\\u{ord(each):04x}" if not each.isalnum() else each for each in name)
    small.write("study.toml", STUDY.replace('probe = "bent"', f'probe = "{written}"'))
    done = run("identify", tmp_path / "study.toml")
    assert done.returncode == 2
    assert "which arm 'three axes' does not have" in done.stderr
    assert not any(unicodedata.category(each) in ("Cc", "Cf") for each in done.stderr.replace("\n", ""))
    assert max(map(len, done.stderr.splitlines())) <= LONGEST + 20


def test_what_people_write_stays() -> None:
    for said in ("Prüfstab „links“ ⌀ 25 mm", "两个 探针", "2 problems:\n- one\twith a tab\n- another", "µm² ≤ ±"):
        assert for_people(said) == said
