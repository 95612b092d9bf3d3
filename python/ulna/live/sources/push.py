"""`push://127.0.0.1:8765/?token=…`: a WebSocket server here, to which somebody's script sends readings.

A message is a JSON object: "q", a list of numbers; it may have "names" of them, "t", the device's clock in seconds, and
"button". One sends at a time. Without a token nobody beyond this machine may.
"""

from __future__ import annotations

import hmac
import ipaddress
import threading
from http import HTTPStatus
from typing import Any
from urllib.parse import parse_qs, urlsplit

from ulna.ground.errors import UlnaInputError
from ulna.live.decode.decoder import Decoder
from ulna.live.decode.json_values import JsonValues
from ulna.live.source_file import StatedSource
from ulna.live.sources.mailbox import Mailbox, taken_port
from ulna.live.sources.wire import WireSource
from ulna.live.tables import FieldsTable

MOST_BYTES = 1 << 20


class PushWire:
    """A server for one sender."""

    messages = True

    def __init__(self, host: str, port: int, token: str | None) -> None:
        """Raises UlnaInputError where the port is taken, or a token is missing."""
        from websockets.sync.server import serve

        self.device = f"push://{host}:{port}"
        if not token and not _here(host):
            raise UlnaInputError(
                f"source '{self.device}': others than this machine could send; expected a token that they must know: "
                f"{self.device}/?token=WORDS. Add it."
            )
        self._token = token
        self._mailbox = Mailbox()
        self._busy = threading.Lock()
        try:
            self._server: Any = serve(
                self._sent, host, port, process_request=self._admit, max_size=MOST_BYTES, close_timeout=1
            )
        except OSError as error:
            raise taken_port(self.device, error) from None
        self.port = self._server.socket.getsockname()[1]
        threading.Thread(target=self._server.serve_forever, daemon=True, name=f"serves {self.device}").start()

    def _admit(self, connection: Any, request: Any) -> Any:
        if not self._token:
            # a page in a browser of this machine is not somebody's script
            return (
                None
                if request.headers.get("Origin") is None
                else connection.respond(HTTPStatus.FORBIDDEN, "no pages\n")
            )
        said = request.headers.get("Authorization", "").removeprefix("Bearer ")
        said = said or parse_qs(urlsplit(request.path).query).get("token", [""])[0]
        if hmac.compare_digest(said.encode(), self._token.encode()):
            return None
        return connection.respond(HTTPStatus.UNAUTHORIZED, "the token is wrong or missing\n")

    def _sent(self, connection: Any) -> None:
        from websockets.exceptions import ConnectionClosed

        if not self._busy.acquire(blocking=False):
            connection.close(1013, "somebody else sends already")
            return
        try:
            for message in connection:
                self._mailbox.put(message.encode() if isinstance(message, str) else message)
        except ConnectionClosed:
            pass  # whoever sent may come again; what lacks meanwhile is a gap
        finally:
            self._busy.release()

    def receive(self) -> list[bytes]:
        """As `Wire`."""
        return self._mailbox.taken()

    def close(self) -> None:
        """As `Wire`."""
        self._server.shutdown()


def _here(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def wire(stated: StatedSource) -> PushWire:
    """The server of a source."""
    url = stated.url
    url.check(("wait", "token"), host=True, port=True)
    return PushWire(url.host, url.port or 0, url.options.get("token"))


def open_source(stated: StatedSource) -> WireSource:
    """As the registry asks. Raises UlnaInputError."""
    decoder: Decoder = JsonValues(["q"], "names", None, "t", "s", "button", loose=True)
    if stated.file.decode is not None:
        decoder = stated.decoder(FieldsTable(), midway=False, messages=True)
    wait_s = stated.url.number("wait", 60, 0.1, 86400)
    return WireSource(wire(stated), decoder, stated.file.map.unit, wait_s)
