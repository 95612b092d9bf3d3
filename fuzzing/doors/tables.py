"""A table of readings through each command that takes one. What writes it is a file of each format."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random

from fuzzing.bites import spoilt_bytes
from fuzzing.cells import Table, spoilt_table
from fuzzing.room import Room
from fuzzing.trial import Trial
from fuzzing.values import text

Writer = Callable[[Table, Random], bytes]
"""A table as the bytes of a file; raises what it likes where the format has no word for a cell."""


@dataclass(frozen=True)
class TableDoor:
    """One format of tables."""

    ending: str
    write: Writer
    flipped: float = 0.2
    """Share of inputs whose bytes are spoilt afterwards."""

    def __call__(self, room: Room, source: Random) -> Trial:
        content = self._written(source)
        if source.random() < self.flipped:
            content = spoilt_bytes(content, source)
        name = f"readings{self.ending}"
        files = {name: content}
        command = source.choice(_COMMANDS)
        if "spoilt.toml" in command:
            files["spoilt.toml"] = _study(name, source)
        return Trial.of(command, name, files)

    def _written(self, source: Random) -> bytes:
        for _ in range(20):
            try:
                return self.write(spoilt_table(source), source)
            except Exception:  # the writer's own library has no word for such a cell: another table then
                continue
        return self.write(Table.plain(), source)


_COMMANDS = (
    "measure out/result.json {file}",
    "measure out/result.json {file} --angle counts --json",
    "measure out/result.json {file} -o points.csv --covariance",
    "measure arm.toml {file} -o points.xlsx",
    "measure arm.toml {file} -o points.parquet --angle deg",
    "measure arm.toml {file} --like made/study.toml",
    "identify spoilt.toml",
    "identify spoilt.toml",
    "identify spoilt.toml --json",
    "new --readings {file} --artefact bar:200 --arm arm.toml --angle counts -o fresh",
    "new --readings {file}",
    "show {file}",
)


def _study(name: str, source: Random) -> bytes:
    keys = source.choice(
        [
            "",
            "",
            "",
            "skip_bad = true",
            'where = { id = ["r1", "r2"] }',
            'split = { column = "id", fit = "r1" }',
            'columns = { q1 = "q2", q2 = "q1" }',
            f"ignore = [{_quoted(text(source))}]",
            'fill_down = ["feature"]',
            "header = false",
            "header = 2",
            "units_row = true",
            'dataset = "run"',
            'sheet = "run"',
            'comment = "#"',
            'encoding = "cp1252"',
            'decimal = ","',
            'separator = ";"',
            'thousands = "\'"',
        ],
    )
    return (
        'format = "ulna-study/1"\narm = "arm.toml"\nunits = { length = "mm", angle = "rad" }\n'
        f'artefact = {{ bar = {{ kind = "{source.choice(["bar", "bar", "seat", "points", "length", "sphere"])}", '
        f'length = 200.0 }} }}\n[[readings]]\nfile = "{name}"\nangle = "counts"\nartefact = "bar"\nprobe = "bent"\n'
        f"{keys}\n"
    ).encode("utf-8", "surrogatepass")


def _quoted(value: str) -> str:
    return "'" + value.replace("'", "").replace("\n", "").replace("\r", "") + "'"
