"""Types that all rooms share: arrays by what they hold, and who is told how far long work is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
"""Numbers; the docstring that names one says its shape and unit."""
I64 = NDArray[np.int64]
"""Counts, rows, places in a list."""
Bool = NDArray[np.bool_]
"""Whether or not."""
Texts = NDArray[np.object_]
"""Labels, names: of str."""
Arrays = dict[str, NDArray[Any]]
"""By name: what comes of a piece of work."""
Progress = Callable[[str, int, int], None]
"""(what is being done, how much of it is done, how much there is)"""
