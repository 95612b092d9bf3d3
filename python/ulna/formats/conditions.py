"""What a cell must hold for its row to be used: the conditions of `where`, as they are written in a study."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from ulna.formats.models import Strict


def _number(value: Any) -> Any:
    """Neither true nor a date is one."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise PydanticCustomError(
            "condition", "a text in quotes, a number, a list of these, or { above, below, not, empty }"
        )
    return value


Number = Annotated[float, BeforeValidator(_number)]


def _one_kind(value: Any) -> str:
    return "<text>" if isinstance(value, str) else "<number>"


def _condition_kind(value: Any) -> str:
    if isinstance(value, dict | Range):  # as it is written, and as it was read
        return "<range>"
    return "<list>" if isinstance(value, list) else _one_kind(value)


Value = Annotated[Annotated[str, Tag("<text>")] | Annotated[Number, Tag("<number>")], Discriminator(_one_kind)]
OneOrMore = Annotated[
    Annotated[str, Tag("<text>")] | Annotated[Number, Tag("<number>")] | Annotated[list[Value], Tag("<list>")],
    Discriminator(_condition_kind),
]


class Range(Strict):
    """What a cell must be beside one of some values: a number between two limits, themselves not included; none of some
    values; empty, or filled. All that is said must hold."""

    above: float | None = None
    below: float | None = None
    excluded: OneOrMore | None = Field(default=None, alias="not")
    """A text, a number, or a list of these: the cell holds none of them. An empty cell holds none."""
    empty: bool | None = None
    """Whether the cell is empty."""

    @model_validator(mode="after")
    def _some(self) -> Range:
        low, high = self.above, self.below
        given = [each for each in (low, high, self.excluded, self.empty) if each is not None]
        if not given or (low is not None and high is not None and not low < high):
            raise PydanticCustomError(
                "range",
                "above, below, or both with above the smaller one; not = a text, a number or a list; empty = true",
            )
        return self


Condition = Annotated[
    Annotated[str, Tag("<text>")]
    | Annotated[Number, Tag("<number>")]
    | Annotated[list[Value], Tag("<list>")]
    | Annotated[Range, Tag("<range>")],
    Discriminator(_condition_kind),
]
