"""`udp://:9000`: datagrams that come to a port of this machine; `udp://127.0.0.1:9000` from this machine alone."""

from __future__ import annotations

import socket

from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource
from ulna.live.sources.mailbox import taken_port
from ulna.live.sources.wire import WireSource
from ulna.live.tables import FieldsTable


class UdpWire:
    """A port. Of datagrams some may be lost on their way; a device's clock shows it as a gap."""

    messages = True

    def __init__(self, host: str, port: int) -> None:
        """Raises UlnaInputError where the port is taken."""
        self.device = f"udp://{host}:{port}"
        try:
            family, kind, _, _, address = socket.getaddrinfo(
                host or "0.0.0.0", port, type=socket.SOCK_DGRAM, flags=socket.AI_PASSIVE
            )[0]
            self._socket = socket.socket(family, kind)
            try:
                self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
                self._socket.bind(address)
            except OSError:
                self._socket.close()
                raise
        except OSError as error:
            raise taken_port(self.device, error) from None
        self._socket.settimeout(0.1)

    def receive(self) -> list[bytes]:
        """As `Wire`."""
        try:
            return [self._socket.recv(65536)]
        except TimeoutError:
            return []
        except OSError as error:
            raise SourceEnded(f"{self.device}: broken ({error.strerror or error}).") from None

    def close(self) -> None:
        """As `Wire`."""
        self._socket.close()


def wire(stated: StatedSource) -> UdpWire:
    """The port of a source."""
    url = stated.url
    url.check(("wait",), port=True)
    return UdpWire(url.host, url.port or 0)


def open_source(stated: StatedSource) -> WireSource:
    """As the registry asks. Raises UlnaInputError."""
    decoder = stated.decoder(FieldsTable(), midway=False, messages=True)
    wait_s = stated.url.number("wait", 5, 0.1, 3600)
    return WireSource(wire(stated), decoder, stated.file.map.unit, wait_s)
