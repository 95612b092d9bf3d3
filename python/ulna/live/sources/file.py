"""`file:run.journal?speed=10`: a recording as it came, faster, or as fast as can be; of a journal, or of a CSV file."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Iterator
from pathlib import Path
from typing import Protocol

from ulna.formats.toml import read_bytes
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.decode.decoder import Row, TooLong
from ulna.live.decode.fields import ANY, Fields
from ulna.live.faults import ENDED, TOO_LONG, Fault
from ulna.live.journal import MAGIC, SAMPLES, Reading
from ulna.live.samples import MOST_CHANNELS, Hello, Samples
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource
from ulna.live.sources.wire import as_samples
from ulna.live.tables import FieldsTable

HOST, DEVICE, BUTTON = "t_host_s", "t_device_s", "button"
"""Columns of a CSV file that are no channels."""
AT_ONCE = 4096
"""Samples that a read gives at most."""


class Blocks(Protocol):
    """The samples of a recording, block by block."""

    hello: Hello
    faults: list[Fault]

    def __iter__(self) -> Iterator[Samples]:
        """From the first. Raises SourceEnded where it cannot go on."""


class JournalBlocks:
    """The samples of a journal."""

    def __init__(self, path: Path) -> None:
        self._reading = Reading(path)
        self.hello = self._reading.hello
        self.faults: list[Fault] = []

    def __iter__(self) -> Iterator[Samples]:
        for record in self._reading:
            if record.kind == SAMPLES:
                yield record.content
        if self._reading.cut is not None:
            self.faults.append(Fault(ENDED, time.monotonic(), self._reading.cut))


class CsvBlocks:
    """The rows of a CSV file: a line of names, then numbers. Without a column of times (`t_host_s`, s) they came at the
    rate that the url says."""

    def __init__(self, path: Path, table: FieldsTable, unit: str | None, rate_hz: float) -> None:
        """Raises UlnaInputError where its first lines are none."""
        first = read_bytes(path, "a journal or a CSV file", 1 << 16).split(b"\n", 1)[0].decode("utf-8-sig", "replace")
        cells = [
            cell.strip() for cell in (first.split(table.separator) if table.separator else ANY.split(first.strip()))
        ]
        if table.prefix is not None and cells[0] == table.prefix:
            del cells[0]
        self._skip = not all(_is_number(cell) for cell in cells)
        names = tuple(table.names) if table.names else tuple(cells) if self._skip else None
        if self._skip and names is not None and len(set(names)) < len(names) and not table.names:
            raise UlnaInputError(f"{path}: line 1: a column is there twice; expected each name once. Correct it.")
        device = table.time if table.time else DEVICE
        scale = table.time_unit if table.time else "s"
        button = table.button or BUTTON
        self._path, self._rate_hz = path, rate_hz
        self._fields = Fields(table.separator, table.prefix, names, device, scale, button)
        if names is None:
            self._fields = Fields(table.separator, table.prefix, tuple(f"c{k + 1}" for k in range(len(cells))))
        channels = self._fields.channels or ()
        self._host = channels.index(HOST) if HOST in channels else None
        self._kept = [k for k, name in enumerate(channels) if k != self._host]
        if not any(cells):
            raise UlnaInputError(
                f"{path}: line 1 is empty; expected a line of names or of numbers first. Record it again."
            )
        if not 0 < len(self._kept) <= MOST_CHANNELS:
            raise UlnaInputError(
                f"{path}: line 1: {len(self._kept)} channels; expected 1 to {MOST_CHANNELS}, with a line of names or "
                "of numbers first. Name those that are read in [decode] names."
            )
        names_kept = tuple(channels[k] for k in self._kept)
        self.hello = Hello(names_kept, unit, str(path), None if self._host is not None else rate_hz)
        self.faults: list[Fault] = []

    def __iter__(self) -> Iterator[Samples]:
        """Raises SourceEnded at a line that is too long."""
        count = 0
        with self._path.open("rb") as stream:
            if self._skip:
                stream.readline()
            while data := stream.read(1 << 16):
                yield self._block(data, count, False)
                count = self._count
            yield self._block(b"", count, True)
            self.faults += self._fields.skipped.taken(end=True)

    def _block(self, data: bytes, count: int, whole: bool) -> Samples:
        try:
            rows = self._fields.feed(data, count / self._rate_hz, whole)
        except TooLong as error:
            self.faults.append(Fault(TOO_LONG, time.monotonic(), str(error)))
            raise SourceEnded(f"{self._path}: {error}") from None
        self.faults += self._fields.skipped.taken()
        self._count = count + len(rows)
        return as_samples([self._timed(row, count + k) for k, row in enumerate(rows)], len(self._kept))

    def _timed(self, row: Row, number: int) -> Row:
        t_host_s = number / self._rate_hz if self._host is None else row.values[self._host]
        return Row(t_host_s, row.t_device_s, tuple(row.values[k] for k in self._kept), row.button)


class FileSource:
    """A recording. Its times are those that it was recorded with, whatever the speed."""

    def __init__(self, blocks: Blocks, speed: float | None) -> None:
        """speed: 1 is as it came; None as fast as can be."""
        self.hello = blocks.hello
        self._blocks = blocks
        self._coming = iter(blocks)
        self._speed = speed
        self._began: tuple[float, float] | None = None
        self._left: deque[Samples] = deque()
        self._faults: list[Fault] = []

    def read(self, timeout_s: float) -> Samples:
        """As `Source`."""
        while not self._left:
            block = next(self._coming, None)
            if block is None:
                why = worded("{device}: the end of the recording.", device=self.hello.device)
                self._faults.append(Fault(ENDED, time.monotonic(), why))
                raise SourceEnded(why)
            if len(block):
                self._left.append(block)
        block = self._left.popleft()
        n = self._due(block, timeout_s)
        if n < len(block):
            self._left.appendleft(block[n:])
        return block[:n]

    def _due(self, block: Samples, timeout_s: float) -> int:
        """How many of a block are to be given now; waits for the first."""
        if self._speed is None:
            return min(len(block), AT_ONCE)
        if self._began is None:
            self._began = (time.monotonic(), float(block.t_host_s[0]))
        wall_s, first_s = self._began
        due_s = wall_s + (block.t_host_s - first_s) / self._speed
        time.sleep(max(0.0, min(float(due_s[0]) - time.monotonic(), timeout_s)))
        return min(int((due_s <= time.monotonic()).sum()), AT_ONCE)

    def faults(self) -> list[Fault]:
        """As `Source`."""
        found = [*self._blocks.faults, *self._faults]
        self._faults, self._blocks.faults = [], []
        return found

    def close(self) -> None:
        """As `Source`."""
        self._left.clear()


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def open_source(stated: StatedSource) -> FileSource:
    """As the registry asks. Raises UlnaInputError."""
    url = stated.url
    url.check(("speed", "rate"))
    speed = None if url.options.get("speed") == "max" else url.number("speed", 1.0, 1e-3, 1e6)
    path = stated.folder / url.path
    if read_bytes(path, "a journal or a CSV file", len(MAGIC)) == MAGIC:
        return FileSource(JournalBlocks(path), speed)
    table = stated.file.decode or FieldsTable()
    if not isinstance(table, FieldsTable):
        raise UlnaInputError(
            f"{stated.path}: key 'decode.kind': got '{table.kind}'; expected \"fields\" of a CSV file."
        )
    rate_hz = url.number("rate", 100.0, 1e-3, 1e6)
    return FileSource(CsvBlocks(path, table, stated.file.map.unit, rate_hz), speed)
