"""What brings bytes, as a source: one thread hears, one decodes and reads, nothing is lost between them."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Iterable
from typing import Protocol

import numpy as np

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import kept, worded
from ulna.live.decode.decoder import Decoder, Row, TooLong
from ulna.live.faults import ENDED, TOO_LONG, Fault
from ulna.live.samples import MOST_CHANNELS, Hello, Samples
from ulna.live.source import SourceEnded

MOST_WAITING = 256 << 20
"""Bytes that may wait for their reader: a minute of the fastest line; more is a reader that does not read."""


class Wire(Protocol):
    """Brings bytes. `receive` is called by one thread, `close` by another."""

    device: str
    """For people."""
    messages: bool
    """Whether each piece of bytes is a message of its own."""

    def receive(self) -> Iterable[bytes]:
        """What came; waits a tenth of a second at most. Raises SourceEnded with the sentence why."""

    def close(self) -> None:
        """May be called twice."""


class WireSource:
    """A source made of a wire and a decoder."""

    def __init__(
        self,
        wire: Wire,
        decoder: Decoder,
        unit: str | None,
        wait_s: float,
        rate_hz: float | None = None,
        counts_per_turn: tuple[float, ...] | None = None,
    ) -> None:
        """counts_per_turn: of each channel, where the device tells it.

        Waits for the first reading where the decoder does not know its channels. Raises UlnaInputError.
        """
        self._wire, self._decoder = wire, decoder
        self._pieces: deque[tuple[float, bytes]] = deque()
        self._came = threading.Event()
        self._heard = self._taken = 0  # bytes; each is written by one thread
        self._why: str | None = None
        self._closed = self._end_said = False
        self._rows: list[Row] = []
        self._faults: list[Fault] = []
        self._thread = threading.Thread(target=self._hear, daemon=True, name=f"hears {wire.device}")
        self._thread.start()
        try:
            self.hello = Hello(self._channels(wait_s), unit, wire.device, rate_hz, counts_per_turn)
        except BaseException:
            self.close()
            raise

    def _hear(self) -> None:
        why: str = worded("it was closed.")
        try:
            while not self._closed:
                for piece in self._wire.receive():
                    self._pieces.append((time.monotonic(), piece))
                    self._heard += len(piece)
                    self._came.set()
                if self._heard - self._taken > MOST_WAITING:
                    many = MOST_WAITING >> 20
                    raise SourceEnded(
                        worded("{device}: more than {many} MB wait to be read.", device=self._wire.device, many=many)
                    )
        except SourceEnded as ended:
            why = kept(ended)
        except Exception as error:  # whatever a driver raises of a cable that is gone
            why = worded("{device}: gone ({why}).", device=self._wire.device, why=_reason(error))
        if self._why is None:
            self._why = why
        self._came.set()

    def _channels(self, wait_s: float) -> tuple[str, ...]:
        until = time.monotonic() + wait_s
        while self._decoder.channels is None:
            try:
                self._take(max(min(until - time.monotonic(), 0.1), 0.0))
            except SourceEnded as ended:
                raise UlnaInputError(
                    worded("{why} No reading came before. Check the device.", why=kept(ended))
                ) from None
            if time.monotonic() > until and self._decoder.channels is None:
                said = self._decoder.skipped
                heard = worded("; {count} bytes came that are none", count=said.bytes) if said.bytes else ""
                shown = next((worded(": {fault}", fault=fault.text) for fault in said.taken(end=True)), ".")
                raise UlnaInputError(
                    worded(
                        "{device}: no reading in {seconds} s{heard}{shown} Expected lines of numbers, or what [decode] "
                        "says. See what comes with: ulna live guess",
                        device=self._wire.device,
                        seconds=f"{wait_s:g}",
                        heard=heard,
                        shown=shown,
                    )
                )
        if len(self._decoder.channels) > MOST_CHANNELS:
            raise UlnaInputError(
                f"{self._wire.device}: {len(self._decoder.channels)} channels; expected {MOST_CHANNELS} at most. Name "
                'those that are read, and "-" for others, in [decode] names.'
            )
        return self._decoder.channels

    def _take(self, timeout_s: float) -> None:
        """Decodes what waits. Raises SourceEnded when there is nothing more."""
        if not self._pieces and self._why is None:
            self._came.wait(timeout_s)
        self._came.clear()
        while self._pieces:
            t_host_s, piece = self._pieces.popleft()
            self._taken += len(piece)
            try:
                self._rows += self._decoder.feed(piece, t_host_s, self._wire.messages)
            except TooLong as error:
                self._rows += error.rows
                self._why = worded("{device}: {why}", device=self._wire.device, why=kept(error))
                self._faults.append(Fault(TOO_LONG, t_host_s, self._why))
                self._end_said = True
                self._pieces.clear()
                self._closed = True
        if self._why is not None and not self._rows and not self._pieces:
            self._faults += self._decoder.skipped.taken(end=True)
            if not self._end_said:
                self._faults.append(Fault(ENDED, time.monotonic(), self._why))
                self._end_said = True
            raise SourceEnded(self._why)

    def read(self, timeout_s: float) -> Samples:
        """As `Source`."""
        if not self._rows:
            self._take(timeout_s)
        rows, self._rows = self._rows, []
        return as_samples(rows, len(self.hello.channels))

    def faults(self) -> list[Fault]:
        """As `Source`."""
        found = [*self._decoder.skipped.taken(), *self._faults]
        self._faults = []
        return found

    def close(self) -> None:
        """As `Source`."""
        self._closed = True
        self._wire.close()
        if self._thread is not threading.current_thread():
            self._thread.join(timeout=2.0)


def as_samples(rows: list[Row], channels: int) -> Samples:
    """Rows as arrays."""
    if not rows:
        return Samples.none(channels)
    t_host_s, t_device_s, values, button = zip(*rows, strict=True)
    return Samples(
        np.array(t_host_s, dtype=float),
        None if None in t_device_s else np.array(t_device_s, dtype=float),
        np.array(values, dtype=float).reshape(len(rows), channels),
        None if None in button else np.array(button, dtype=bool),
    )


def _reason(error: Exception) -> str:
    strerror = getattr(error, "strerror", None)
    return str(strerror or str(error) or type(error).__name__)
