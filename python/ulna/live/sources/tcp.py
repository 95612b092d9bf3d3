"""`tcp://host:port`: a connection to a server that sends readings."""

from __future__ import annotations

import socket

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource
from ulna.live.sources.wire import WireSource
from ulna.live.tables import FieldsTable


class TcpWire:
    """A connection."""

    messages = False

    def __init__(self, host: str, port: int) -> None:
        """Raises UlnaInputError where nobody answers."""
        self.device = f"tcp://{host}:{port}"
        try:
            self._socket = socket.create_connection((host, port), timeout=5.0)
        except OSError as error:
            raise UlnaInputError(
                worded(
                    "{device}: nobody answers ({why}); expected a device that sends readings. Check the address, and "
                    "that it is on.",
                    device=self.device,
                    why=str(error.strerror or error),
                )
            ) from None
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        self._socket.settimeout(0.1)

    def receive(self) -> list[bytes]:
        """As `Wire`."""
        try:
            found = self._socket.recv(65536)
        except TimeoutError:
            return []
        except OSError as error:
            why = str(error.strerror or error)
            raise SourceEnded(worded("{device}: the connection broke ({why}).", device=self.device, why=why)) from None
        if not found:
            raise SourceEnded(worded("{device}: the other side ended the connection.", device=self.device))
        return [found]

    def close(self) -> None:
        """As `Wire`."""
        self._socket.close()


def wire(stated: StatedSource) -> TcpWire:
    """The connection of a source."""
    url = stated.url
    url.check(("wait",), host=True, port=True)
    return TcpWire(url.host, url.port or 0)


def open_source(stated: StatedSource) -> WireSource:
    """As the registry asks. Raises UlnaInputError."""
    decoder = stated.decoder(FieldsTable(), midway=False, messages=False)
    wait_s = stated.url.number("wait", 5, 0.1, 3600)
    return WireSource(wire(stated), decoder, stated.file.map.unit, wait_s)
