"""`serial:/dev/ttyACM0?baud=115200`: a serial line, or a pseudo-terminal."""

from __future__ import annotations

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.decode.decoder import Decoder
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource
from ulna.live.sources.wire import WireSource
from ulna.live.tables import FieldsTable
from ulna.live.url import Url

KNOWN = ("baud", "parity", "stop", "wait")
BAUD = 115200


class SerialWire:
    """A port, read as soon as one byte is there."""

    messages = False

    def __init__(self, path: str, baud: int, parity: str = "none", stop: float = 1, timeout_s: float = 0.1) -> None:
        """timeout_s: how long the first byte is waited for. Raises UlnaInputError where it cannot be opened."""
        import serial

        self.device = path
        try:
            self._port = serial.Serial(
                path, baud, timeout=timeout_s, write_timeout=1.0, parity=parity[0].upper(), stopbits=stop
            )
        except (OSError, ValueError, serial.SerialException) as error:
            raise UlnaInputError(
                worded(
                    "serial:{port}: cannot be opened ({why}); expected a serial port. See which there are with: ulna "
                    "live ports",
                    port=path,
                    why=_said(error),
                )
            ) from None

    def receive(self) -> list[bytes]:
        """As `Wire`."""
        try:
            found = self._port.read(self._port.in_waiting or 1)
        except (OSError, TypeError) as error:  # pyserial reads of None when it was closed meanwhile
            raise self._gone(error) from None
        return [found] if found else []

    def send(self, data: bytes) -> None:
        """To the device. Raises SourceEnded where it is gone."""
        try:
            self._port.write(data)
        except (OSError, TypeError) as error:
            raise self._gone(error) from None

    def _gone(self, error: Exception) -> SourceEnded:
        return SourceEnded(
            worded(
                "{device}: the cable was pulled, or the device is off ({why}).", device=self.device, why=_said(error)
            )
        )

    def close(self) -> None:
        """As `Wire`."""
        self._port.close()


def _said(error: Exception) -> str:
    import os

    number = getattr(error, "errno", None)
    return os.strerror(number) if isinstance(number, int) else str(error)


def port_of(url: Url) -> str:
    """The port that a url names. Raises UlnaInputError."""
    path = f"//{url.host}{url.path}" if url.host else url.path
    if not path:
        raise UlnaInputError(
            f"source '{url.text}': expected {url.scheme}:PORT, such as {url.scheme}:/dev/ttyACM0. Correct it."
        )
    return path


def wire(stated: StatedSource) -> SerialWire:
    """The port of a source."""
    url = stated.url
    url.check(KNOWN)
    baud = int(url.number("baud", BAUD, 50, 20_000_000))
    path = port_of(url)
    return SerialWire(path, baud, url.word("parity", "none", ("none", "even", "odd")), url.number("stop", 1, 1, 2))


def open_source(stated: StatedSource) -> WireSource:
    """As the registry asks. Raises UlnaInputError."""
    decoder: Decoder = stated.decoder(FieldsTable(), midway=True, messages=False)
    wait_s = stated.url.number("wait", 5, 0.1, 3600)
    return WireSource(wire(stated), decoder, stated.file.map.unit, wait_s)
