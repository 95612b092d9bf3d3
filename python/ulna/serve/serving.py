"""A server that runs: on this machine alone, until it is ended."""

from __future__ import annotations

import signal
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import uvicorn

from ulna.ground.errors import UlnaInputError
from ulna.serve.app import make_app
from ulna.serve.guarding import Guests
from ulna.serve.workshop import Workshop

HOST = "127.0.0.1"
USUAL_PORT = 8765
NAMES = ("127.0.0.1", "localhost")
"""Of this machine, as a browser on it may say it."""


def serve(folder: Path, port: int | None, by: str | None, ready: Callable[[str], None]) -> None:
    """Until Ctrl-C or SIGTERM. port: None: 8765, or another where that is taken; 0: any. ready: is given the address
    to open, once it answers. Raises UlnaInputError."""
    listening = listening_at(port)
    workshop = Workshop(folder, by)
    try:
        server_of(workshop, listening, ready).run(sockets=[listening])
    finally:
        workshop.close()


def server_of(workshop: Workshop, listening: socket.socket, ready: Callable[[str], None]) -> uvicorn.Server:
    """What answers for a bench at an open port; its `run` returns once `should_exit` is set, or at Ctrl-C."""
    own = listening.getsockname()[1]
    guests = Guests(own)
    config = uvicorn.Config(
        make_app(workshop, guests, frozenset(f"{name}:{own}" for name in NAMES)),
        log_level="warning",
        access_log=False,
        ws="websockets-sansio",
        ws_max_size=1 << 16,
        timeout_graceful_shutdown=2,
        server_header=False,
        lifespan="off",
    )
    return _Server(config, lambda: ready(f"http://{HOST}:{own}/#token={guests.token}"))


class _Server(uvicorn.Server):
    """One that says when it is there."""

    def __init__(self, config: uvicorn.Config, ready: Callable[[], None]) -> None:
        super().__init__(config)
        self._ready = ready

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Ctrl-C, or being asked to end, is how it ends; nothing is raised anew. In a thread there are no signals."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        before = {number: signal.signal(number, self.handle_exit) for number in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        self._ready()


def listening_at(port: int | None) -> socket.socket:
    """port: as for `serve`. Raises UlnaInputError where it is taken."""
    tried = [USUAL_PORT, 0] if port is None else [port]
    for each in tried:
        made = socket.socket()
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            made.bind((HOST, each))
            made.listen(64)
        except OSError as error:
            made.close()
            if each == tried[-1]:
                raise UlnaInputError(
                    f"option --port: {each} cannot be listened at ({error.strerror}). Name another, or 0 for any."
                ) from None
        else:
            return made
    raise AssertionError(tried)
