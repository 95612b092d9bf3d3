"""Types of arrays, and of what reports progress."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Bool = NDArray[np.bool_]

Progress = Callable[[str, int, int], None]
"""Called with (stage, done, total)."""
