"""Pieces of work, those left out that a ledger keeps already; and what a job is, in a word that changes with it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.ground.arrays import Arrays
from ulna.work.ledger import Ledger
from ulna.work.pieces import Workers


def each_once(
    workers: Workers,
    work: Callable[[Any], Arrays],
    pieces: Sequence[Any],
    ledger: Ledger | None,
    numbers: Sequence[int] | None = None,
) -> Iterator[tuple[int, Arrays]]:
    """(place in `pieces`, what came of the piece): first what the ledger keeps, then the rest as it is finished.

    numbers: of the pieces in the whole job, by which the ledger knows them; None: 0, 1, …
    """
    named = range(len(pieces)) if numbers is None else numbers
    missing = []
    for place, number in enumerate(named):
        kept = None if ledger is None else ledger.kept(number)
        if kept is None:
            missing.append(place)
        else:
            yield place, kept
    for done, arrays in workers.each(work, [pieces[place] for place in missing]):
        place = missing[done]
        if ledger is not None:
            ledger.keep(named[place], arrays)
        yield place, arrays


def sha256_of(*content: str | NDArray[Any] | None) -> str:
    """Of texts and arrays, in their order: what numbers depend on."""
    digest = hashlib.sha256()
    for part in content:
        if part is None:
            digest.update(b"-")
        elif isinstance(part, np.ndarray):
            digest.update(f"{part.shape}{part.dtype}".encode() + np.ascontiguousarray(part).tobytes())
        else:
            digest.update(part.encode())
        digest.update(b"\0")
    return digest.hexdigest()
