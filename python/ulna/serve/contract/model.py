"""What all models of the wire share."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, GetJsonSchemaHandler, PlainSerializer, PlainValidator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from ulna.ground.worded import Worded
from ulna.serve.places import without_places

LONGEST = 4000
"""Characters of a sentence."""


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


class Wording(Said):
    """A sentence: in English, and what it is made of, so that it can be said in other languages."""

    text: str
    """The whole of it, in English."""
    template: str | None = None
    """ "moved {moved} mm while touching": by it a catalogue knows the sentence; None: it is said in English alone."""
    values: dict[str, str | Wording] = Field(default_factory=dict)
    """What stands in the place of each name in it."""

    @classmethod
    def of(cls, sentence: str) -> Wording:
        """Of a sentence, worded or plain."""
        if not isinstance(sentence, Worded):
            return cls(text=sentence)
        values = {
            name: cls.of(value) if isinstance(value, Worded) else value for name, value in sentence.values.items()
        }
        return cls(text=sentence, template=sentence.template, values=values)


def shortened(sentence: str) -> str:
    """As much of it as goes over the wire."""
    return sentence if len(sentence) <= LONGEST else sentence[:LONGEST]


def _sentence(given: Any) -> str:
    # a plain validator of strings would hand on a plain string
    if not isinstance(given, str):
        raise ValueError("expected a sentence")
    said = without_places(given)
    if len(said) > LONGEST:
        raise ValueError(f"expected {LONGEST} characters at most")
    return said


class _OnTheWire:
    """What stands for a sentence in the schema."""

    def __get_pydantic_json_schema__(self, _: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        return handler(Wording.__pydantic_core_schema__)


Sentence = Annotated[str, PlainValidator(_sentence), PlainSerializer(Wording.of), _OnTheWire()]
"""A string here, which may be `worded`; a `Wording` on the wire. It names files as they came, never where a bench keeps
them."""


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
    detail: str
    said: Wording
    """The same, for a page in another language."""
