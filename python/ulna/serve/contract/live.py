"""Live events: one union, told apart by `event`; newest frames are binary, see `ulna.serve.live.frames`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.activities import Activity, Meter, Next, State, Stream, TipNow, Touch
from ulna.serve.contract.jobs import Job
from ulna.serve.contract.model import Said, Sentence


class HelloEvent(Said):
    """The first: who speaks, and by which contract."""

    event: Literal["hello"] = "hello"
    version: str
    contract: str
    """SHA-256 of the schema: a page of another one must be loaded anew."""
    activity: Activity | None


class StreamEvent(Said):
    """How the source is, once a second."""

    event: Literal["stream"] = "stream"
    stream: Stream


class FaultEvent(Said):
    """Something is wrong with the stream."""

    event: Literal["fault"] = "fault"
    kind: str
    sentence: Sentence


class TouchEvent(Said):
    """A touch was taken: it is in the journal."""

    event: Literal["touch"] = "touch"
    touch: Touch
    sentences: list[Sentence]


class RefusedEvent(Said):
    """A touch was not taken."""

    event: Literal["refused"] = "refused"
    sentence: Sentence


class KnownEvent(Said):
    """What is known now, and where to touch next."""

    event: Literal["known"] = "known"
    meter: Meter
    next: Next | None


class StateEvent(Said):
    """The whole state, where it changed otherwise."""

    event: Literal["state"] = "state"
    state: State


class TipEvent(Said):
    """Where the tip is, ten times a second, of a read-out."""

    event: Literal["tip"] = "tip"
    tip: TipNow


class SaidEvent(Said):
    """A sentence."""

    event: Literal["said"] = "said"
    sentence: Sentence


class EndedEvent(Said):
    """The activity is over; what it left is named in it."""

    event: Literal["ended"] = "ended"
    activity: Activity


class JobEvent(Said):
    """A job went on."""

    event: Literal["job"] = "job"
    job: Job


LiveEvent = Annotated[
    HelloEvent
    | StreamEvent
    | FaultEvent
    | TouchEvent
    | RefusedEvent
    | KnownEvent
    | StateEvent
    | TipEvent
    | SaidEvent
    | EndedEvent
    | JobEvent,
    Field(discriminator="event"),
]
