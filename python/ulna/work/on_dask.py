"""Pieces of work handed to the workers of a Dask cluster. Needs the extra `ulna[dask]`."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from ulna.ground.errors import UlnaInputError

TIMEOUT_S = 10
"""How long the scheduler may take to answer."""
RETRIES = 5
"""How often a piece is begun again that a lost worker had; a worker that dies takes nothing else along."""


def _distributed() -> Any:
    """Dask's package, which has no types. Raises ImportError."""
    return importlib.import_module("distributed")


class DaskWorkers:
    """The workers of a cluster, through its client."""

    def __init__(self, client: Any) -> None:
        self._client = client

    def each(self, work: Callable[[Any], Any], pieces: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        """See `ulna.work.pieces.Workers`. Pieces of a worker that dies are done by the others."""
        numbers = {
            self._client.submit(work, piece, pure=False, retries=RETRIES): number for number, piece in enumerate(pieces)
        }
        try:
            for future in _distributed().as_completed(list(numbers), loop=self._client.loop):
                yield numbers.pop(future), future.result()
        finally:
            self._client.cancel(list(numbers))


@contextmanager
def dask_workers(address: str) -> Iterator[DaskWorkers]:
    """The workers of the cluster whose scheduler has this address, such as ``tcp://10.0.0.7:8786``.

    Raises UlnaInputError where Dask is not installed or nothing answers there.
    """
    try:
        distributed = _distributed()
    except ImportError:
        raise UlnaInputError(
            f"--dask {address}: Dask is not installed; expected it beside Ulna, here and where the workers are. "
            "Install ulna[dask]."
        ) from None
    try:
        client = distributed.Client(address, timeout=TIMEOUT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        told = str(error).strip().splitlines()
        raise UlnaInputError(
            f"--dask {address}: no scheduler answers there ({told[0] if told else type(error).__name__}); expected the "
            "address that `dask scheduler` printed, such as tcp://10.0.0.7:8786. Start it, or correct the address."
        ) from None
    try:
        yield DaskWorkers(client)
    finally:
        client.close(timeout=TIMEOUT_S)
