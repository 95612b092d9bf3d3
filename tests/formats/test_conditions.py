"""Conditions that say what a cell must not hold, and whether it is empty."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ulna.formats.rows import Selection
from ulna.formats.table import read_header
from ulna.study.readings.columns import ReadingsEntry


def test_what_is_not_and_what_is_empty(tmp_path: Path) -> None:
    """Against the same choice made row by row in Python."""
    rows = [("good", "1"), ("bad", "2"), ("", "3"), ("Skip", ""), ("good", "5"), ("", "")]
    (tmp_path / "t.csv").write_text("note,n\n" + "".join(f"{note},{n}\n" for note, n in rows))
    conditions: list[tuple[dict[str, Any], Callable[[str, str], bool]]] = [
        ({"note": {"not": "bad"}}, lambda note, n: note != "bad"),
        ({"note": {"not": ["bad", "Skip"]}}, lambda note, n: note not in ("bad", "Skip")),
        ({"note": {"empty": True}}, lambda note, n: note == ""),
        ({"note": ""}, lambda note, n: note == ""),
        ({"note": ["", "good"]}, lambda note, n: note in ("", "good")),
        ({"note": {"empty": False, "not": "good"}}, lambda note, n: note not in ("", "good")),
        ({"n": {"not": 5, "above": 1}}, lambda note, n: n != "" and float(n) != 5 and float(n) > 1),
        ({"n": {"not": [1, 2]}, "note": {"empty": True}}, lambda note, n: note == "" and n not in ("1", "2")),
    ]
    header = read_header(tmp_path / "t.csv")
    texts = header.cells(lambda _: False, ["note", "n"])
    for where, meant in conditions:
        entry = ReadingsEntry.model_validate({"file": "t.csv", "where": where})
        chosen = Selection(entry.where or {}, None, "fit", "s.toml: key 'readings.1").of(texts, header, [])
        assert chosen.tolist() == [k for k, row in enumerate(rows) if meant(*row)], where
