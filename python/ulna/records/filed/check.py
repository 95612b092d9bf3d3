"""A check before work: its figures, with limit, uncertainty and verdict."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from ulna.checking.result_file import load_check
from ulna.records.acts.act import Row
from ulna.records.filed.kind import BAD, OUT, About, FiledKind, Read, figure


class CheckKind(FiledKind):
    """`ulna-check/1`."""

    name = "check"
    format = "ulna-check"

    def read(self, path: Path) -> Read:
        """The arm's name and when."""
        file = load_check(path)[0]
        return Read(file.arm, file.time, {})

    def rows(self, content: bytes, about: About) -> Iterator[Row]:
        """Each figure of each place; one that its history contradicts is out of control, whatever its limit says."""
        for found in json.loads(content)["figures"]:
            history = found["history"] or {}
            out = found["verdict"] != BAD and history.get("in_control") is False
            place = " ".join(dict.fromkeys([found["test"], *found["of"].values()]))
            yield figure(
                about,
                self.name,
                "check",
                found["key"],
                found["value"],
                artefact=place,
                u=found["u"],
                k=found["expanded"] / found["u"] if found["u"] else None,
                limit_value=found["limit"],
                verdict=OUT if out else found["verdict"],
            )
