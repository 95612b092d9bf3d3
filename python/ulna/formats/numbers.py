"""Numbers as files may state them."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

Positive = Annotated[float, Field(gt=0)]
Amount = Annotated[float, Field(ge=0)]
Uncertainty = Amount
Count = Annotated[int, Field(ge=1, le=10_000_000)]
Coordinates = Annotated[list[float], Field(min_length=3, max_length=3)]
