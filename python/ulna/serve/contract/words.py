"""What is said to an activity. A word is a row of the union."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Asked, Name


class DoTouch(Asked):
    """A touch now: a key, a pedal."""

    word: Literal["touch"]


class DoMoved(Asked):
    """The artefact was put elsewhere."""

    word: Literal["moved"]


class DoWithdraw(Asked):
    """A touch shall not count; nothing is deleted."""

    word: Literal["withdraw"]
    number: Annotated[int, Field(ge=1)]
    reason: Annotated[str, Field(min_length=1, max_length=500)]


class DoHoldOut(Asked):
    """From now on so many fresh places, not fitted; 0: touches are fitted again."""

    word: Literal["hold-out"]
    places: Annotated[int, Field(ge=0, le=100)]


class DoTrust(Asked):
    """The angles are right again."""

    word: Literal["trust"]


class DoFeature(Asked):
    """The next touch begins a new feature of a kind: point, length, ball, circle, plane, distance."""

    word: Literal["feature"]
    kind: Name


class DoTakeBack(Asked):
    """The last point does not count."""

    word: Literal["take-back"]


class DoGo(Asked):
    """The virtual arm goes to a posture, in place of all that it was told before; then to others, one after another."""

    word: Literal["go"]
    q_deg: Annotated[list[float], Field(min_length=1, max_length=16)]
    then_deg: Annotated[list[Annotated[list[float], Field(min_length=1, max_length=16)]], Field(max_length=100)] = (
        Field(default_factory=list)
    )


class DoFollow(Asked):
    """The virtual hand does what is asked for next, or stops doing so."""

    word: Literal["follow"]
    follows: bool


class DoAnswer(Asked):
    """The answer to a question that a commissioning asks."""

    word: Literal["answer"]
    answer: Literal["yes", "again", "skip", "endless"]


class DoEnd(Asked):
    """It is over: what it leaves is written."""

    word: Literal["end"]


Do = Annotated[
    DoTouch | DoMoved | DoWithdraw | DoHoldOut | DoTrust | DoFeature | DoTakeBack | DoGo | DoFollow | DoAnswer | DoEnd,
    Field(discriminator="word"),
]
