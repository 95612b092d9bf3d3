"""Any other file that belongs to an arm: readings, a study, a photograph, a certificate from elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ulna.records.acts.act import Row
from ulna.records.filed.kind import About, FiledKind, Read


class OtherKind(FiledKind):
    """It is kept as it is; nothing is read of it."""

    name = "file"
    format = None

    def read(self, path: Path) -> Read:
        """Nothing."""
        return Read(None, None, {})

    def rows(self, content: bytes, about: About) -> Iterator[Row]:
        """None."""
        return iter(())
