"""`ws://host:port/path`: a WebSocket server that sends readings, a message each or several."""

from __future__ import annotations

from contextlib import ExitStack
from typing import Any

from ulna.ground.errors import UlnaInputError
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource
from ulna.live.sources.wire import WireSource
from ulna.live.tables import FieldsTable

MOST_BYTES = 1 << 20
"""Of a message."""


class WsWire:
    """A connection."""

    messages = True

    def __init__(self, address: str, device: str, token: str | None = None) -> None:
        """Raises UlnaInputError where nobody answers."""
        from websockets.exceptions import InvalidHandshake, InvalidURI
        from websockets.sync.client import connect

        self.device = device
        headers = None if token is None else {"Authorization": f"Bearer {token}"}
        self._leave = ExitStack()
        try:
            self.connection: Any = self._leave.enter_context(
                connect(address, open_timeout=5, max_size=MOST_BYTES, additional_headers=headers, proxy=None)
            )
        except (OSError, InvalidHandshake, InvalidURI, EOFError) as error:
            raise UlnaInputError(
                f"{device}: nobody answers as a WebSocket ({_said(error)}); expected a server that sends readings. "
                "Check the address, and that it is on."
            ) from None

    def receive(self) -> list[bytes]:
        """As `Wire`."""
        message = self.message()
        return [] if message is None else [message]

    def message(self) -> bytes | None:
        """The next, or None after a tenth of a second. Raises SourceEnded."""
        from websockets.exceptions import ConnectionClosed

        try:
            found: str | bytes = self.connection.recv(timeout=0.1)
        except TimeoutError:
            return None
        except (ConnectionClosed, OSError) as error:
            raise SourceEnded(f"{self.device}: the connection ended ({_said(error)}).") from None
        return found.encode() if isinstance(found, str) else found

    def close(self) -> None:
        """As `Wire`."""
        self._leave.close()


def _said(error: Exception) -> str:
    return str(getattr(error, "strerror", None) or error).rstrip(".") or type(error).__name__


def wire(stated: StatedSource) -> WsWire:
    """The connection of a source."""
    url = stated.url
    url.check(("wait", "token"), host=True)
    port = "" if url.port is None else f":{url.port}"
    device = f"{url.scheme}://{url.host}{port}{url.path}"
    return WsWire(device, device, url.options.get("token"))


def open_source(stated: StatedSource) -> WireSource:
    """As the registry asks. Raises UlnaInputError."""
    decoder = stated.decoder(FieldsTable(), midway=False, messages=True)
    wait_s = stated.url.number("wait", 5, 0.1, 3600)
    return WireSource(wire(stated), decoder, stated.file.map.unit, wait_s)
