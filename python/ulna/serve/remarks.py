"""What readers remark on files that they take: said to whoever asked, not to the server's terminal."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from ulna.ground.errors import InputWarning
from ulna.ground.worded import kept

_LOCK = threading.Lock()
"""Python keeps what becomes of warnings for all threads together: one at a time listens."""


@contextmanager
def remarks() -> Iterator[list[str]]:
    """What is remarked meanwhile, each thing once. For what takes moments: others wait."""
    said: list[str] = []
    with _LOCK, warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        try:
            yield said
        finally:
            said += dict.fromkeys(kept(each.message) for each in caught if isinstance(each.message, InputWarning))
