"""Pieces of work handed to the workers of a Dask cluster. Needs the extra `ulna[dask]`."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any

from ulna.ground.errors import UlnaInputError
from ulna.ground.version import VERSION
from ulna.work.dask_scheduler import check_address, check_scheduler, distributed, no_workers, workers_known

TIMEOUT_S = 10
"""How long the scheduler may take to take work, or to let go."""
RETRIES = 5
"""How often a piece is begun again that a lost worker had; a worker that dies takes nothing else along."""
_LOOK_S = 0.02
SILENT_S = 3.0
"""After so long without a finished piece the scheduler is asked whether it is still there, and has workers."""


class _OtherVersionError(Exception):
    """A worker's Ulna is another than the one that asks."""


def _piece(version: str, work: Callable[[Any], Any], piece: Any) -> Any:
    """On a worker: the work, by the same Ulna."""
    if version != VERSION:
        raise _OtherVersionError(VERSION)
    return work(piece)


class DaskWorkers:
    """The workers of a cluster, through its client."""

    def __init__(self, client: Any, address: str) -> None:
        self._client = client
        self._address = address

    def each(self, work: Callable[[Any], Any], pieces: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        """See `ulna.work.pieces.Workers`. Pieces of a worker that dies are done by the others.

        Raises UlnaInputError where the scheduler is lost, no worker is left, or a worker has not this Ulna.
        """
        job = partial(_piece, VERSION, work)
        numbers = {
            self._client.submit(job, piece, pure=False, retries=RETRIES): number for number, piece in enumerate(pieces)
        }
        try:
            for future in self._finished(list(numbers)):
                number = numbers.pop(future)
                yield number, self._result(future)
        finally:
            with suppress(Exception):
                self._client.cancel(list(numbers))

    def _finished(self, futures: list[Any]) -> Iterator[Any]:
        """Futures as they end; while none does, the scheduler is looked at."""
        ended = distributed().as_completed(futures, loop=self._client.loop)
        heard = time.monotonic()
        while ended.count():
            if ended.has_ready():
                yield from ended.next_batch(block=False)
                heard = time.monotonic()
            elif time.monotonic() - heard > SILENT_S:
                self._still_there()
                heard = time.monotonic()
            else:
                time.sleep(_LOOK_S)

    def _still_there(self) -> None:
        """Raises UlnaInputError where the scheduler has no workers, or does not answer twice: it may be busy."""
        try:
            known = workers_known(self._address)
        except UlnaInputError:
            known = workers_known(self._address)
        if not known:
            check_scheduler(self._address)

    def _result(self, future: Any) -> Any:
        dask = distributed()
        try:
            return future.result()
        except dask.client.FutureCancelledError:
            raise UlnaInputError(
                f"--dask {self._address}: the scheduler is gone, and the work that it had; expected it to stay until "
                "all is done. Start it again; with --keep what was finished is not done twice."
            ) from None
        except dask.scheduler.NoValidWorkerError:
            raise no_workers(self._address) from None
        except dask.KilledWorker:
            raise UlnaInputError(
                f"--dask {self._address}: a piece of work ended every worker that took it; expected "
                "workers with enough memory for it (their logs say more). Give them more, or work without --dask."
            ) from None
        except _OtherVersionError as other:
            raise self._other(f"Ulna {other}") from None
        except (ModuleNotFoundError, AttributeError) as error:
            if "Can't get attribute" in str(error) or str(getattr(error, "name", "")).split(".")[0] == "ulna":
                raise self._other(f"another Ulna or none ({error})") from None
            raise

    def _other(self, has: str) -> UlnaInputError:
        return UlnaInputError(
            f"--dask {self._address}: a worker has {has}; expected Ulna {VERSION}, as here. Install that one where the "
            "workers are, and start them again."
        )


@contextmanager
def dask_workers(address: str) -> Iterator[DaskWorkers]:
    """The workers of the cluster whose scheduler has this address, such as ``tcp://10.0.0.7:8786``.

    Raises UlnaInputError where Dask is not installed, no scheduler answers there, or it has no workers.
    """
    try:
        dask = distributed()
    except ImportError:
        raise UlnaInputError(
            f"--dask {address}: Dask is not installed; expected it beside Ulna, here and where the workers are. "
            "Install ulna[dask]."
        ) from None
    _quiet()
    check_address(address)
    check_scheduler(address)
    client = dask.Client(address, timeout=TIMEOUT_S, set_as_default=False)
    try:
        yield DaskWorkers(client, address)
    finally:
        with suppress(Exception):
            client.close(timeout=TIMEOUT_S)


def _quiet() -> None:
    """What Dask logs of a lost connection is said by Ulna, in one sentence."""
    for name in list(logging.root.manager.loggerDict):
        if name.split(".")[0] in ("distributed", "tornado"):
            logging.getLogger(name).setLevel(logging.CRITICAL)
