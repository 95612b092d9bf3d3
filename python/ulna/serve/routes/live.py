"""The live socket: every event as JSON text, the newest frame as bytes."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Annotated

from fastapi import APIRouter, Query, WebSocket, WebSocketDisconnect

from ulna.ground.errors import UlnaInputError
from ulna.ground.version import VERSION
from ulna.serve.contract.live import HelloEvent
from ulna.serve.hub import Listener
from ulna.serve.workshop import Workshop

router = APIRouter()
TOO_SLOW, NOT_THERE = 4008, 4404
"""Why a socket is closed, beside 4401 and 4403 of the guard."""


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
    """Until whoever listens goes: what they send is not for this socket and is dropped."""
    sending, hearing = asyncio.create_task(_send(socket, listener)), asyncio.create_task(_hear(socket))
    done, rest = await asyncio.wait({sending, hearing}, return_when=asyncio.FIRST_COMPLETED)
    for task in rest:
        task.cancel()
    for task in (*done, *rest):
        with suppress(asyncio.CancelledError, WebSocketDisconnect, RuntimeError):
            await task


async def _send(socket: WebSocket, listener: Listener) -> None:
    while not listener.too_slow:
        found = await listener.next()
        await (socket.send_text(found) if isinstance(found, str) else socket.send_bytes(found))
    await socket.close(TOO_SLOW)


async def _hear(socket: WebSocket) -> None:
    while True:
        await socket.receive()
