"""An arm file: an arm as drawn, or as somebody's calibration left it. It says no figure."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ulna.arm.arm import Arm
from ulna.records.acts.act import Row
from ulna.records.filed.kind import About, FiledKind, Read


class ArmKind(FiledKind):
    """`ulna-arm/1`."""

    name = "arm"
    format = "ulna-arm"

    def read(self, path: Path) -> Read:
        """Its name."""
        return Read(Arm.load(path).name, None, {})

    def rows(self, content: bytes, about: About) -> Iterator[Row]:
        """None."""
        return iter(())
