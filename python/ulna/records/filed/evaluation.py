"""An arm, unchanged, on readings: what it was found to do."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from ulna.calibration.result_file import EvaluationFile
from ulna.formats.models import fill_json
from ulna.formats.toml import check_format, read_json
from ulna.records.acts.act import Row
from ulna.records.filed.kind import About, FiledKind, Read, figures_mm


class EvaluationKind(FiledKind):
    """`ulna-evaluation/1`."""

    name = "evaluation"
    format = "ulna-evaluation"

    def read(self, path: Path) -> Read:
        """The arm's name and when."""
        document, _ = read_json(path, "an evaluation.json")
        check_format(document, path, self.format)
        file = fill_json(EvaluationFile, document, path)
        return Read(file.arm, None if file.provenance is None else file.provenance.time, {})

    def rows(self, content: bytes, about: About) -> Iterator[Row]:
        """Its figures: as found."""
        yield from figures_mm(about, self.name, "as-found", json.loads(content)["overall"])
