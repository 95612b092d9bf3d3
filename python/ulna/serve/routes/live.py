"""The live socket: every event as JSON text, the newest frame as bytes."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Annotated

from fastapi import APIRouter, Query, WebSocket, WebSocketDisconnect

from ulna.ground.errors import UlnaInputError
from ulna.ground.version import VERSION
from ulna.serve.contract.live import HelloEvent
from ulna.serve.entrance import Entrance
from ulna.serve.guests import Guests
from ulna.serve.hub import Listener
from ulna.serve.workshop import Workshop

router = APIRouter()
TOO_SLOW, NOT_KNOWN, NOT_THERE = 4008, 4401, 4404
"""Why a socket is closed. The guard refuses before there is one: with 401 and 403, as of any request."""
CLOSE_S = 1.0
"""How long one that does not read is told so."""
LOOK_S = 5.0
"""How often it is asked whether whoever listens still may."""


@router.websocket("/live")
async def live(socket: WebSocket, activity: Annotated[str | None, Query(max_length=200)] = None) -> None:
    """First a hello with how the activity stands, then what happens, until either side goes."""
    workshop: Workshop = socket.app.state.workshop
    loop = asyncio.get_running_loop()
    listener = Listener(loop, activity)
    await socket.accept()
    workshop.hub.join(listener)
    try:
        try:
            stands = None if activity is None else await asyncio.to_thread(workshop.hall.activity, activity)
        except UlnaInputError:
            await socket.close(NOT_THERE)
            return
        hello = HelloEvent(version=VERSION, contract=socket.app.state.contract, activity=stands)
        await socket.send_text(hello.model_dump_json())
        await _both(socket, listener)
    finally:
        workshop.hub.leave(listener)


async def _both(socket: WebSocket, listener: Listener) -> None:
    """Until whoever listens goes, or is too slow: one that does not read is waited for no longer. What they send is not
    for this socket and is dropped."""
    works = (_send(socket, listener), _hear(socket), listener.gone.wait(), _until_gone(socket))
    tasks = [asyncio.create_task(each) for each in works]
    _, rest = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    for task in rest:
        task.cancel()
    for task in tasks:
        with suppress(asyncio.CancelledError, WebSocketDisconnect, RuntimeError):
            await task
    if listener.gone.is_set():
        with suppress(TimeoutError, WebSocketDisconnect, RuntimeError):
            await asyncio.wait_for(socket.close(TOO_SLOW), CLOSE_S)


async def _send(socket: WebSocket, listener: Listener) -> None:
    while True:
        found = await listener.next()
        await (socket.send_text(found) if isinstance(found, str) else socket.send_bytes(found))


async def _until_gone(socket: WebSocket) -> None:
    """Until whoever listens signed out, or may not any more."""
    guests: Guests = socket.app.state.guests
    entrance: Entrance = socket.app.state.entrance
    cookie = guests.cookie_of(socket.headers)
    while True:
        await asyncio.sleep(LOOK_S)
        name = guests.known(cookie)
        if name is None or await asyncio.to_thread(entrance.person, name) is None:
            await socket.close(NOT_KNOWN)
            return


async def _hear(socket: WebSocket) -> None:
    while True:
        await socket.receive()
