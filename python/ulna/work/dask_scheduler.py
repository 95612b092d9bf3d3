"""Who answers at the address of a Dask scheduler: asked before any work is sent, and again where nothing comes back."""

from __future__ import annotations

import asyncio
import importlib
import time
from contextlib import suppress
from typing import Any

from ulna.ground.errors import UlnaInputError

CONNECT_S = 3.0
"""How long a connection may take."""
ANSWER_S = 5.0
"""How long, with the connection, whoever listens there may take to say who it is."""
WORKERS_S = 4.0
"""How long workers that are still starting are waited for: with the answer, less than ten seconds."""
_ASK_S = 0.5
_SCHEMES = ("tcp", "tls")


def distributed() -> Any:
    """Dask's package, which has no types. Raises ImportError."""
    return importlib.import_module("distributed")


def check_address(address: str) -> None:
    """Raises UlnaInputError where it cannot be a scheduler's address, or wants certificates that nobody stated."""
    scheme, found, rest = address.rpartition("://")
    host, _, port = rest.rpartition(":")
    if (found and scheme not in _SCHEMES) or not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise _refused(address, "is no address of a scheduler")
    if scheme == "tls" and not distributed().Security().get_connection_args("client").get("ssl_context"):
        raise UlnaInputError(
            f"--dask {address}: TLS without certificates; expected distributed.comm.tls.ca-file and .client.cert in "
            "Dask's settings (~/.config/dask/*.yaml, or DASK_DISTRIBUTED__COMM__TLS__CA_FILE and "
            "…__TLS__CLIENT__CERT). State those of the cluster."
        )


def check_scheduler(address: str) -> None:
    """Raises UlnaInputError unless a scheduler answers there that has workers, or has them soon."""
    until = time.monotonic() + WORKERS_S
    while not (workers := workers_known(address)):
        if time.monotonic() > until:
            raise no_workers(address)
        time.sleep(_ASK_S)
    assert workers


def workers_known(address: str) -> int:
    """How many workers the scheduler at this address has now. Raises UlnaInputError where none answers."""
    try:
        said = asyncio.run(_who(address))
    except TimeoutError:
        raise _refused(address, f"something listens there, but is no scheduler: no answer in {ANSWER_S:g} s") from None
    except (OSError, ValueError, TypeError, EOFError) as error:
        told = str(error).strip().splitlines()
        raise _refused(address, f"no scheduler answers there ({told[0] if told else type(error).__name__})") from None
    kind = said.get("type") if isinstance(said, dict) else None
    if kind != "Scheduler":
        scheduler = f"; its scheduler is {said['scheduler']}" if isinstance(said, dict) and "scheduler" in said else ""
        raise _refused(address, f"who answers there is a {str(kind)[:20].lower()}, not a scheduler{scheduler}")
    return len(said["workers"])


def no_workers(address: str) -> UlnaInputError:
    """What is said of a scheduler that has nobody to work."""
    return UlnaInputError(
        f"--dask {address}: the scheduler has no workers; expected at least one. Start some, with "
        f"`dask worker {address}` on any machine."
    )


async def _who(address: str) -> Any:
    security = distributed().Security()
    there = importlib.import_module("distributed.core").rpc(
        address, timeout=CONNECT_S, connection_args=security.get_connection_args("client")
    )
    try:
        return await asyncio.wait_for(there.identity(), ANSWER_S)
    finally:
        with suppress(Exception):
            await asyncio.wait_for(there.close_rpc(), 1.0)


def _refused(address: str, what: str) -> UlnaInputError:
    return UlnaInputError(
        f"--dask {address}: {what}; expected the address that `dask scheduler` printed, such as tcp://10.0.0.7:8786. "
        "Start it, or correct the address."
    )
