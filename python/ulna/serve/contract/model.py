"""What all models of the wire share."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field


class Said(BaseModel):
    """What the server says: numbers are JSON numbers, never NaN or infinity."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, allow_inf_nan=False, json_schema_mode_override="serialization"
    )


class Asked(BaseModel):
    """What a client asks: no unknown key, no silent conversion."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, strict=True)


Sha256 = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$", description="SHA-256 of a file's bytes")]
Name = Annotated[str, Field(min_length=1, max_length=200)]
Sentence = Annotated[str, Field(max_length=4000)]


class Value(Said):
    """A number as a person reads it: rounded by its uncertainty, and as it was computed."""

    text: str
    """The value, rounded; a dash where there is none."""
    u_text: str | None = None
    """U (k = 2), rounded; None where there is none."""
    unit: str
    value: float | None
    u: float | None = None
    """Standard uncertainty."""


class Problem(Said):
    """RFC 9457: what was wrong, in the command line's words."""

    type: str = "about:blank"
    title: str
    status: int
    detail: Sentence
