"""A server that runs until it is ended: for one person on this machine, or for a laboratory."""

from __future__ import annotations

import signal
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import uvicorn

from ulna.ground.errors import UlnaInputError
from ulna.serve.app import make_app
from ulna.serve.entrance import OwnEntrance
from ulna.serve.guarding import Guard, Reach
from ulna.serve.guests import Guests
from ulna.serve.laboratory.entrance import LaboratoryEntrance
from ulna.serve.laboratory.settings_file import Settings
from ulna.serve.sources import allow_listed
from ulna.serve.workshop import Workshop

HOST = "127.0.0.1"
USUAL_PORT = 8765
NAMES = ("127.0.0.1", "localhost")
"""Of this machine, as a browser on it may say it."""
Ready = Callable[[str], None]


def serve(folder: Path, port: int | None, by: str | None, ready: Ready) -> None:
    """For one person, on this machine alone, until Ctrl-C or SIGTERM. port: None: 8765, or another where that is taken;
    0: any. ready: is given the address to open, once it answers. Raises UlnaInputError."""
    listening = listening_at(HOST, [USUAL_PORT, 0] if port is None else [port], "option --port")
    _until_ended(listening, Workshop(folder, by), lambda workshop: server_of(workshop, listening, ready))


def serve_laboratory(folder: Path, settings: Settings, by: str | None, ready: Ready) -> None:
    """For people who sign in, over TLS or behind a proxy that speaks it, until it is ended. by: who works where nobody
    is signed in: who opens the record. Raises UlnaInputError."""
    workshop = laboratory_workshop(folder, settings, by)
    try:
        stated = settings.file.listen
        listening = listening_at(stated.address, [stated.port], "key 'listen'")
    except UlnaInputError:
        workshop.close()
        raise
    _until_ended(listening, workshop, lambda each: laboratory_server_of(each, listening, settings, ready))


def laboratory_workshop(folder: Path, settings: Settings, by: str | None) -> Workshop:
    """A bench as a laboratory's server opens it. Raises UlnaInputError where nobody could sign in as an admin."""
    stated = settings.file.sources
    return Workshop(folder, by, allow_listed(stated.hosts, stated.serial))


def server_of(workshop: Workshop, listening: socket.socket, ready: Ready) -> uvicorn.Server:
    """What answers for a bench at an open port; its `run` returns once `should_exit` is set, or at Ctrl-C."""
    own = listening.getsockname()[1]
    entrance = OwnEntrance(workshop.records.bench.by)
    reach = Reach(frozenset(f"{name}:{own}" for name in NAMES))
    app = make_app(workshop, Guests(own), entrance, reach)
    return _Server(_config(app), lambda: ready(f"http://{HOST}:{own}/#token={entrance.token}"))


def laboratory_server_of(
    workshop: Workshop, listening: socket.socket, settings: Settings, ready: Ready
) -> uvicorn.Server:
    """The same for people who sign in."""
    file, own = settings.file, listening.getsockname()[1]
    entrance = LaboratoryEntrance(workshop.records, settings)
    proxies = None if file.proxy is None else frozenset(file.proxy.addresses)
    reach = Reach(frozenset(file.names), ("https",), proxies)
    guests = Guests(own, secure=True, session_s=3600.0 * file.sign_in.hours)
    config = _config(
        make_app(workshop, guests, entrance, reach), ssl_certfile=settings.certificate, ssl_keyfile=settings.key
    )
    return _Server(config, lambda: ready(settings.origin))


def _config(app: Guard, **more: Any) -> uvicorn.Config:
    return uvicorn.Config(
        app,
        log_level="warning",
        access_log=False,
        ws="websockets-sansio",
        ws_max_size=1 << 16,
        timeout_graceful_shutdown=2,
        server_header=False,
        proxy_headers=False,
        lifespan="off",
        **more,
    )


def _until_ended(listening: socket.socket, workshop: Workshop, made: Callable[[Workshop], uvicorn.Server]) -> None:
    try:
        made(workshop).run(sockets=[listening])
    finally:
        workshop.close()


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


def listening_at(address: str, ports: list[int], what: str) -> socket.socket:
    """The first of some ports that is free. Raises UlnaInputError where none is."""
    for port in ports:
        made = socket.socket(socket.AF_INET6 if ":" in address else socket.AF_INET)
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            made.bind((address, port))
            made.listen(64)
        except OSError as error:
            made.close()
            if port == ports[-1]:
                raise UlnaInputError(
                    f"{what}: {address}, port {port} cannot be listened at ({error.strerror}). Name another, or 0 for "
                    "any."
                ) from None
        else:
            return made
    raise AssertionError(ports)
