"""Journals, `ulna-journal/1`: what came and what was done, appended, each record with its checksum.

The file is the line "ulna-journal/1" and records: the length of the content (4 bytes, lowest first), its kind (1
byte), the CRC-32 of kind and content (4 bytes), the content. The first record is the head. A record that was cut, or
whose checksum is wrong, at the end of the file was being written when the power went: it is left out, and that is said.
"""

from __future__ import annotations

import json
import math
import os
import struct
import time
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO

import numpy as np

from ulna.formats.output import unwritable
from ulna.ground.errors import UlnaInputError
from ulna.live.samples import MOST_CHANNELS, Hello, Samples

MAGIC = b"ulna-journal/1\n"
WHAT = "a journal (ulna-journal/1)"
HEAD, SAMPLES, TOUCH, WITHDRAWAL, EVENT = range(1, 6)
_RECORD = struct.Struct("<IBI")
_BLOCK = struct.Struct("<IHB")
_TIMED, _BUTTON = 1, 2
MOST_BYTES = 64 << 20
"""Of one record; more is damage."""
_LOOKED_AT = 1 << 20
"""Bytes behind a bad record in which others are looked for."""


@dataclass(frozen=True)
class Record:
    """One record, as it was written."""

    kind: int
    """HEAD, SAMPLES, TOUCH, WITHDRAWAL or EVENT."""
    content: Any
    """`Samples`, or what JSON has."""
    at: int
    """Byte at which it begins."""


def packed(samples: Samples) -> bytes:
    """Samples as a block, exact to the last bit."""
    flags = (_TIMED if samples.t_device_s is not None else 0) | (_BUTTON if samples.button is not None else 0)
    parts = [samples.t_host_s.astype("<f8").tobytes()]
    if samples.t_device_s is not None:
        parts.append(samples.t_device_s.astype("<f8").tobytes())
    parts.append(samples.raw.astype("<f8").tobytes())
    if samples.button is not None:
        parts.append(samples.button.astype("u1").tobytes())
    head = _BLOCK.pack(len(samples), samples.raw.shape[1], flags)
    return head + zlib.compress(b"".join(parts), 1)


def unpacked(block: bytes) -> Samples:
    """What `packed` made. Raises ValueError where it is none."""
    if len(block) < _BLOCK.size:
        raise ValueError("too short")
    n, channels, flags = _BLOCK.unpack_from(block)
    numbers = n * (1 + bool(flags & _TIMED) + channels)
    size = 8 * numbers + (n if flags & _BUTTON else 0)
    if channels > MOST_CHANNELS or size > MOST_BYTES:
        raise ValueError("too large")
    unpacker = zlib.decompressobj()
    try:
        data = unpacker.decompress(block[_BLOCK.size :], size + 1)
    except zlib.error as error:
        raise ValueError(str(error)) from None
    if len(data) != size:
        raise ValueError("of another size than it says")
    values = np.frombuffer(data, "<f8", numbers).astype(float)
    t_device_s = values[n : 2 * n] if flags & _TIMED else None
    raw = values[numbers - n * channels :].reshape(n, channels)
    button = np.frombuffer(data, "u1", n, 8 * numbers).astype(bool) if flags & _BUTTON else None
    return Samples(values[:n], t_device_s, raw, button)


class Journal:
    """A journal that is written. Samples are kept until there are some, or a second is over; a touch is on the disk
    when `touch` returns."""

    def __init__(self, stream: BinaryIO, path: Path) -> None:
        self._stream = stream
        self.path = path
        self._waiting: list[Samples] = []
        self._written_s = time.monotonic()
        self.samples_written = 0

    @classmethod
    def create(cls, path: str | Path, hello: Hello, **head: Any) -> Journal:
        """A new journal; head: what else is to be kept in it. Raises UlnaInputError where there is a file already."""
        path = Path(path)
        try:
            stream = path.open("xb")
        except FileExistsError:
            raise UlnaInputError(f"{path}: exists already and is never overwritten. Name another file.") from None
        except OSError as error:
            raise UlnaInputError(f"{path}: cannot be written ({error.strerror}). Choose another place.") from None
        journal = cls(stream, path)
        with journal._on_disk():
            stream.write(MAGIC)
        described: dict[str, Any] = {
            "channels": list(hello.channels),
            "unit": hello.unit,
            "device": hello.device,
            "rate_hz": hello.rate_hz,
        }
        if hello.counts_per_turn is not None:
            described["counts_per_turn"] = list(hello.counts_per_turn)
        anchor = {"utc": datetime.now(UTC).isoformat(), "monotonic_s": time.monotonic()}
        journal._write(HEAD, _json({"format": "ulna-journal/1", "hello": described, "anchor": anchor, **head}))
        journal.flush()
        return journal

    @classmethod
    def open(cls, path: str | Path) -> tuple[Journal, str | None]:
        """A journal to go on with, and what was cut off its end, in words. Raises UlnaInputError."""
        path = Path(path)
        reading = Reading(path)
        for _ in reading:
            pass
        try:
            stream = path.open("r+b")
            if reading.cut is not None:
                stream.truncate(reading.end)
            stream.seek(reading.end)
        except OSError as error:
            raise UlnaInputError(f"{path}: cannot be written ({error.strerror}). Check its permissions.") from None
        return cls(stream, path), reading.cut

    def samples(self, samples: Samples) -> None:
        """Appends samples, none of them lost but by a kill within a second."""
        if len(samples):
            self._waiting.append(samples)
        if sum(map(len, self._waiting)) >= 4096 or time.monotonic() - self._written_s > 1.0:
            self.flush()

    def touch(self, touch: Mapping[str, Any]) -> None:
        """Appends a touch; it is on the disk when this returns."""
        self._now(TOUCH, touch)

    def withdraw(self, withdrawal: Mapping[str, Any]) -> None:
        """Appends that a touch does not count; it is on the disk when this returns."""
        self._now(WITHDRAWAL, withdrawal)

    def event(self, event: Mapping[str, Any]) -> None:
        """Appends what happened, such as a fault."""
        self._pack()
        self._write(EVENT, _json(event))

    def _now(self, kind: int, content: Mapping[str, Any]) -> None:
        self._pack()
        self._write(kind, _json(content))
        self.flush()
        with self._on_disk():
            os.fsync(self._stream.fileno())

    @contextmanager
    def _on_disk(self) -> Iterator[None]:
        """Raises UlnaInputError where the disk takes no more: what was written stays, and goes on from there."""
        try:
            yield
        except OSError as error:
            raise unwritable(self.path, error) from None

    def _pack(self) -> None:
        """Consecutive samples of one shape as one block."""
        waiting, self._waiting = self._waiting, []
        while waiting:
            shape = _shape(waiting[0])
            same = next((k for k, each in enumerate(waiting) if _shape(each) != shape), len(waiting))
            joined = Samples.joined(waiting[:same])
            for begin in range(0, len(joined), 1 << 16):
                self._write(SAMPLES, packed(joined[begin : begin + (1 << 16)]))
            self.samples_written += len(joined)
            waiting = waiting[same:]

    def _write(self, kind: int, content: bytes) -> None:
        if len(content) > MOST_BYTES:
            raise UlnaInputError(
                f"{self.path}: a record of more than {MOST_BYTES >> 20} MB; expected less. Write less."
            )
        checksum = zlib.crc32(content, zlib.crc32(bytes([kind])))
        with self._on_disk():
            self._stream.write(_RECORD.pack(len(content), kind, checksum) + content)

    def flush(self) -> None:
        """All that was appended goes to the system."""
        self._pack()
        with self._on_disk():
            self._stream.flush()
        self._written_s = time.monotonic()

    def close(self) -> None:
        """All that was appended goes to the disk."""
        if self._stream.closed:
            return
        try:
            self.flush()
            with self._on_disk():
                os.fsync(self._stream.fileno())
        finally:
            with suppress(OSError):  # it was told already
                self._stream.close()

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class Reading:
    """A journal's records, one after another, in memory that does not grow. When it has gone through them, `cut` says
    what was left out at the end and `end` where the last whole record ends."""

    def __init__(self, path: str | Path) -> None:
        """Raises UlnaInputError where it is no journal."""
        self.path = Path(path)
        self.cut: str | None = None
        self.end = 0
        self.head = self._head()
        hello = self.head["hello"]
        unit, rate_hz, counts = hello.get("unit"), hello.get("rate_hz"), hello.get("counts_per_turn")
        told = None if counts is None else tuple(counts)
        self.hello = Hello(tuple(hello["channels"]), unit, str(hello.get("device", self.path)), rate_hz, told)

    def _head(self) -> dict[str, Any]:
        for record in self:
            if record.kind == HEAD and _is_head(record.content):
                content: dict[str, Any] = record.content
                return content
            break
        raise UlnaInputError(
            f"{self.path}: the head of the journal is not whole; expected {WHAT}. It was cut, or damaged."
        )

    def __iter__(self) -> Iterator[Record]:
        """Raises UlnaInputError where it was damaged before its end."""
        from ulna.formats.toml import read_bytes

        if read_bytes(self.path, WHAT, len(MAGIC)) != MAGIC:
            raise UlnaInputError(f"{self.path}: not a journal; expected {WHAT}. Check the path.")
        with self.path.open("rb") as stream:
            size = os.fstat(stream.fileno()).st_size
            at = len(MAGIC)
            stream.seek(at)
            self.cut, self.end = None, at
            while at < size:
                head = stream.read(_RECORD.size)
                length, kind, checksum = _RECORD.unpack(head) if len(head) == _RECORD.size else (0, 0, 0)
                whole = len(head) == _RECORD.size and length <= MOST_BYTES and at + _RECORD.size + length <= size
                content = stream.read(length) if whole else b""
                if not whole or zlib.crc32(content, zlib.crc32(bytes([kind]))) != checksum:
                    stream.seek(at)
                    self._left_out(at, size, stream.read(_LOOKED_AT))
                    return
                at += _RECORD.size + length
                yield Record(kind, self._read(kind, content, at), at - _RECORD.size - length)
                self.end = at

    def _left_out(self, at: int, size: int, tail: bytes) -> None:
        if _has_record(tail[1:]):
            raise UlnaInputError(
                f"{self.path}: damaged at byte {at}: a record's checksum is wrong, and others follow; expected {WHAT} "
                "as it was written. Take a copy of it."
            )
        self.cut = (
            f"{self.path}: the last {size - at} bytes are no whole record, and are left out: it was cut while writing."
        )

    def _read(self, kind: int, content: bytes, end: int) -> Any:
        try:
            return unpacked(content) if kind == SAMPLES else json.loads(content)
        except ValueError as error:
            raise UlnaInputError(
                f"{self.path}: a record before byte {end} cannot be read ({error}); expected {WHAT} as it was written."
            ) from None


def _has_record(data: bytes) -> bool:
    """Whether a whole record stands anywhere: then what is before it was damaged, and no end was cut."""
    for at in range(len(data) - _RECORD.size):
        if HEAD <= data[at + 4] <= EVENT:
            length, kind, checksum = _RECORD.unpack_from(data, at)
            content = data[at + _RECORD.size : at + _RECORD.size + length]
            if length == len(content) and zlib.crc32(content, zlib.crc32(bytes([kind]))) == checksum:
                return True
    return False


def _is_head(content: Any) -> bool:
    hello = content.get("hello") if isinstance(content, dict) else None
    names = hello.get("channels") if isinstance(hello, dict) else None
    if not isinstance(hello, dict) or not isinstance(names, list) or len(names) > MOST_CHANNELS:
        return False
    counts = hello.get("counts_per_turn", [2.0] * len(names))
    told = isinstance(counts, list) and len(counts) == len(names)
    return (
        all(isinstance(name, str) for name in names)
        and told
        and all(type(each) in (int, float) and 2 <= each < math.inf for each in counts)
    )


def _shape(samples: Samples) -> tuple[int, bool, bool]:
    return samples.raw.shape[1], samples.t_device_s is None, samples.button is None


def _json(content: Mapping[str, Any]) -> bytes:
    return json.dumps(content, ensure_ascii=False, separators=(",", ":")).encode()
