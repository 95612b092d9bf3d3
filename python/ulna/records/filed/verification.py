"""An acceptance test: its figures, with limit, uncertainty and verdict, as found and as left."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from ulna.records.acts.act import Row
from ulna.records.filed.kind import About, FiledKind, Read, figure
from ulna.verification.result_file import load_verification


class VerificationKind(FiledKind):
    """`ulna-verification/1`."""

    name = "verification"
    format = "ulna-verification"

    def read(self, path: Path) -> Read:
        """The arm's name and when."""
        file, _ = load_verification(path)
        return Read(file.arm, file.provenance.time, {})

    def rows(self, content: bytes, about: About) -> Iterator[Row]:
        """The worst value of each figure of each test."""
        for state in json.loads(content)["states"]:
            for test in state["tests"]:
                for found in test["figures"]:
                    yield figure(
                        about,
                        self.name,
                        state["state"],
                        found["key"],
                        found["value"],
                        artefact=test["name"],
                        u=found["u"],
                        k=found["k"],
                        limit_value=found["limit"],
                        verdict=found["verdict"],
                    )
