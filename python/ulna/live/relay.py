"""Samples handed on to a push source elsewhere, as JSON over WebSocket."""

from __future__ import annotations

import json
from typing import Any

from ulna.ground.errors import UlnaInputError
from ulna.live.samples import Hello, Samples
from ulna.live.source import SourceEnded
from ulna.live.sources.ws import WsWire
from ulna.live.url import Url


class Relay:
    """A connection to `push://` on another machine."""

    def __init__(self, to: str, hello: Hello) -> None:
        """to: ws://host:port/?token=…  Raises UlnaInputError where nobody answers."""
        url = Url.read(to)
        if url.scheme not in ("ws", "wss"):
            raise UlnaInputError(
                f"'{url.text}': expected ws://host:port/?token=…, where a push: source listens. Correct it."
            )
        url.check(("token",), host=True)
        port = "" if url.port is None else f":{url.port}"
        address = f"{url.scheme}://{url.host}{port}{url.path or '/'}"
        self._wire = WsWire(address, address, url.options.get("token"))
        self._names = list(hello.channels)

    def send(self, samples: Samples) -> None:
        """Every sample, a message each. Raises SourceEnded where the other side is gone."""
        from websockets.exceptions import ConnectionClosed

        try:
            for k in range(len(samples)):
                self._wire.connection.send(json.dumps(self._message(samples, k)))
        except (ConnectionClosed, OSError) as error:
            raise SourceEnded(f"{self._wire.device}: the other side is gone ({str(error).rstrip('.')}).") from None

    def _message(self, samples: Samples, k: int) -> dict[str, Any]:
        message: dict[str, Any] = {"q": samples.raw[k].tolist(), "names": self._names}
        if samples.t_device_s is not None:
            message["t"] = float(samples.t_device_s[k])
        if samples.button is not None:
            message["button"] = bool(samples.button[k])
        return message

    def close(self) -> None:
        """Leaves it. May be called twice."""
        self._wire.close()
