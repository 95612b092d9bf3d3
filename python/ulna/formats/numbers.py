"""Kinds of numbers that files hold, said once: what a table of any room asks of a number."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

Positive = Annotated[float, Field(gt=0)]
"""More than nothing: a length, a scale."""
Amount = Annotated[float, Field(ge=0)]
"""Nothing, or more."""
Uncertainty = Amount
"""A standard uncertainty or deviation, in the unit of its quantity; 0 is exact."""
Count = Annotated[int, Field(ge=1, le=1_000_000)]
"""How many; what no memory holds is a slip of the finger."""
Share = Annotated[float, Field(ge=0, le=10)]
"""Part of something, 1 being all of it; there are shares above one (a bar longer than the reach)."""
Shares = list[Annotated[list[Share], Field(min_length=2, max_length=2)]]
"""[least, most] each."""
Coverage = Annotated[float, Field(gt=0.5, lt=1)]
"""A coverage probability."""
Coordinates = Annotated[list[float], Field(min_length=3, max_length=3)]
"""x, y, z."""
