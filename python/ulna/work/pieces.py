"""What a piece of work is, who may do it, and how it is done in this process."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import AbstractContextManager, nullcontext
from typing import Any, Protocol

from ulna.work.cores import available_cores


class Workers(Protocol):
    """Whoever does pieces of work."""

    def each(self, work: Callable[[Any], Any], pieces: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        """(number of a piece, what came of it), as they are finished, in any order; each exactly once.

        `work` is a function at the top of a module, or a `functools.partial` of one, and it, the pieces and what comes
        of them can be pickled. What the work raises is raised here; after KeyboardInterrupt no piece is begun.
        """


class Threads:
    """Threads of this process: the core lets others run while it computes."""

    def __init__(self, count: int | None = None) -> None:
        """count: None for one a core."""
        self.count = available_cores() if count is None else count

    def each(self, work: Callable[[Any], Any], pieces: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        """See `Workers`."""
        with ThreadPoolExecutor(self.count) as pool:
            waiting = iter(range(len(pieces)))
            running: dict[Future[Any], int] = {}
            try:
                # a piece is begun when one is finished, so that an interruption waits for those alone that run
                for number in waiting:
                    running[pool.submit(work, pieces[number])] = number
                    if len(running) >= self.count:
                        yield from _finished(running)
                while running:
                    yield from _finished(running)
            finally:
                for future in running:
                    future.cancel()


def _finished(running: dict[Future[Any], int]) -> Iterator[tuple[int, Any]]:
    done, _ = wait(running, return_when=FIRST_COMPLETED)
    for future in done:
        yield running.pop(future), future.result()


def workers_at(address: str | None) -> AbstractContextManager[Workers]:
    """This process's threads, or the workers of the Dask cluster whose scheduler has this address.

    Raises UlnaInputError where Dask is not installed or the scheduler does not answer.
    """
    if address is None:
        return nullcontext(Threads())
    from ulna.work.on_dask import dask_workers

    return dask_workers(address)
