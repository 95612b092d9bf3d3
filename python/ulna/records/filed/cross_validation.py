"""A calibration judged by readings left out."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from ulna.calibration.result_file import CrossValidationFile
from ulna.formats.models import fill_json
from ulna.formats.toml import check_format, read_json
from ulna.records.acts.act import Row
from ulna.records.filed.kind import About, FiledKind, Read, figures_mm


class CrossValidationKind(FiledKind):
    """`ulna-cross-validation/1`."""

    name = "cross-validation"
    format = "ulna-cross-validation"

    def read(self, path: Path) -> Read:
        """It names no arm: whoever files it does."""
        document, _ = read_json(path, "a cross-validation.json")
        check_format(document, path, self.format)
        file = fill_json(CrossValidationFile, document, path)
        return Read(None, None if file.provenance is None else file.provenance.time, {})

    def rows(self, content: bytes, about: About) -> Iterator[Row]:
        """Means over what was left out, before and after."""
        document = json.loads(content)
        yield from figures_mm(about, self.name, "left-out-before", document["before"])
        yield from figures_mm(about, self.name, "left-out-after", document["after"])
