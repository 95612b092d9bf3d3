"""Messages that name files as whoever brought them knows them, not by where a bench keeps them."""

from __future__ import annotations

import re

from ulna.ground.worded import Worded

_PLACES = re.compile(r"(?<![\w.])/(?:[^:;,'()\n]*/)?(?:desk/[0-9a-f]{64}|jobs/[0-9a-f]{16}|sessions/[\w-]+)/")
"""Where a bench keeps files."""


def without_places(text: str) -> str:
    """A message that names files as whoever brought them knows them."""
    if isinstance(text, Worded):
        values = {name: without_places(value) for name, value in text.values.items()}
        return text if values == text.values else Worded(text.template, values)
    return _PLACES.sub("", text)
