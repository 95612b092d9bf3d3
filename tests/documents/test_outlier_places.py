"""A report says where in a workbook a reading far off stands, by the cell that its owner sees."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from ulna.documents.content.content import Content
from ulna.documents.languages.words import Words
from ulna.documents.sections.outliers import outliers

ENTRY = {
    "row": 12, "file": "messung.xlsx", "artefact": "bar", "placement": "3", "feature": "A", "probe": "bent",
    "norm_mm": 1.234, "times_scatter": 88.0,
}  # fmt: skip


@pytest.mark.parametrize("language", ["en", "de", "zh"])
@pytest.mark.parametrize(("place", "shown"), [("Messung!A15", "12 (Messung!A15)"), ("line 15", "12"), (None, "12")])
def test_a_cell_is_named_beside_the_row(language: str, place: str | None, shown: str) -> None:
    entry = ENTRY if place is None else ENTRY | {"place": place}
    content = cast(Content, SimpleNamespace(outliers=[entry]))
    table: Any = outliers(content, Words(language), 10)[0]
    assert shown in str(table.rows[0][0])
    assert (place in str(table.rows[0][0])) == ("!" in place) if place else True
