"""What a command made, filed in one go: asked before the long work, kept after it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import select

from ulna.checking.result_file import load_check
from ulna.records import asked
from ulna.records.bench import Bench
from ulna.records.filing import ARMS, Filed, Filing, file_all
from ulna.records.history import withdrawn
from ulna.records.tables import FIGURE
from ulna.study.study import Study


@dataclass(frozen=True)
class Recording:
    """Where outcomes go."""

    bench: Bench
    arm: str
    """As registered."""

    @classmethod
    def of(cls, arm: str) -> Recording:
        """Of the record that the environment or the settings name. Raises UlnaInputError where there is none, or no
        such arm."""
        return cls.at(Bench.open(), arm)

    @classmethod
    def at(cls, bench: Bench, arm: str) -> Recording:
        """Of this record. Raises UlnaInputError where there is no such arm."""
        with bench.reading() as connection:
            return cls(bench, str(asked.equipment(connection, arm, ARMS)["name"]))

    def keep(
        self,
        path: Path,
        with_it: Mapping[str, Path] | None = None,
        artefacts: Sequence[str] = (),
        at: str | None = None,
    ) -> Filed:
        """A file that was written. Raises UlnaInputError."""
        (filed,) = file_all(self.bench, [Filing(path, self.arm, at, artefacts, with_it or {})])
        return filed

    def checks(self, protocol: str) -> list[Path]:
        """Earlier checks of the arm by a protocol of this name, as files."""
        asked_for = (
            select(FIGURE.c.sha256)
            .where(FIGURE.c.arm == self.arm, FIGURE.c.source == "check", FIGURE.c.sha256.not_in(withdrawn()))
            .distinct()
        )
        with self.bench.reading() as connection:
            places = [self.bench.files.place(sha256) for sha256 in connection.scalars(asked_for)]
        return [each for each in places if load_check(each)[0].protocol.name == protocol]


def inputs_of(study: Study) -> dict[str, Path]:
    """What a result was made from, by what it is: the study, the arm, the readings in their order."""
    first, second, *others = [file.path for file in study.files]
    return {"study": first, "arm": second, **{f"readings {k}": path for k, path in enumerate(others, start=1)}}


def lent_by_record(study: Study) -> list[str]:
    """The artefacts of the record on which it rests."""
    names = [group.artefact.record for group in study.readings]
    return list(dict.fromkeys(name for name in names if name is not None))
