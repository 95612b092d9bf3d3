"""How many cores this process may use."""

from __future__ import annotations

import os


def available_cores() -> int:
    """At least 1; what the scheduler grants where the system tells, else all there are."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
