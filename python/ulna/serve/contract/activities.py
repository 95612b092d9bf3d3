"""What is done with a stream: begun, looked at. A kind of activity is a row of each union."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.arms import Bodies
from ulna.serve.contract.guided import BeginCheckTouches, BeginTestTouches, CheckState, TestState
from ulna.serve.contract.model import Asked, Name, Said, Sentence, Sha256, Value
from ulna.serve.contract.sources import Source

# ------------------------------------------------------------ how one begins


class BeginWatch(Asked):
    """A stream, shown: with an arm it moves on the screen."""

    kind: Literal["watch"]
    source: Source
    arm: Sha256 | None = None


class BeginCommission(Asked):
    """Channels, signs, ranges, noise: joint by joint."""

    kind: Literal["commission"]
    source: Source
    arm: Sha256 | None
    """The drawing; None: one is guessed from `joints` and `reach_mm`, or told by the device."""
    joints: Annotated[int, Field(ge=1, le=16)] | None = None
    reach_mm: Annotated[float, Field(gt=0, le=1e5)] | None = None
    zeros: Literal["posture", "known", "unknown"] | None = None
    """From where the zero offsets are; None: as `ulna live commission` has it."""
    counts_per_turn: Annotated[float, Field(ge=2)] | None = None


class BeginTouch(Asked):
    """An artefact, touched until the goal is reached."""

    kind: Literal["touch"]
    source: Source
    arm: Sha256
    plan: Sha256
    """A plan file or a study: what is touched, and what for."""
    goal_mm: Annotated[float, Field(gt=0, le=1000)] | None = None
    """U (k = 2) of a test length."""
    length_mm: Annotated[float, Field(gt=0, le=1e6)] | None = None
    """That test length; None: the plan's."""
    by: Literal["key", "button", "still"] = "still"
    go_on: Name | None = None
    """The id of an interrupted session that goes on."""


class BeginMeasure(Asked):
    """Points and features, with what they are worth."""

    kind: Literal["measure"]
    source: Source
    arm: Sha256
    probe: Name | None = None
    by: Literal["key", "button", "still"] = "still"


Begin = Annotated[
    BeginWatch | BeginCommission | BeginTouch | BeginMeasure | BeginCheckTouches | BeginTestTouches,
    Field(discriminator="kind"),
]

# ------------------------------------------------------------ what is known of it


class Touch(Said):
    """A touch that was taken."""

    number: int
    feature: str
    place: str
    """Number of the place of its artefact."""
    held_out: bool
    withdrawn: str | None
    """Why it does not count."""
    tip_mm: tuple[float, float, float]
    spread: Value
    off: Value | None
    """What the fit of then left of it, when it was taken."""
    times: float | None
    """The same in units of the scatter of all."""
    suspicious: bool


class Next(Said):
    """Where to touch next."""

    sentences: list[Sentence]
    """As `ulna live touch` says it."""
    feature: str
    here: bool
    """Whether the artefact stays where it is."""
    point_mm: tuple[float, float, float]
    places_mm: list[tuple[float, float, float]]
    """Of all its features, where it stands or is to be put."""
    lies: str
    """level, rising, falling, upright, hanging, nowhere."""
    slope_deg: float
    azimuth_deg: float
    elbow: str | None
    comes_from: str
    q_deg: list[float]
    bodies: Bodies
    """The arm in that posture."""


class Unknown(Said):
    """Why something is not known, and what to do."""

    head: Literal["never", "not yet", "weak"]
    names: Sentence
    """ "zero of joint 6 with x of probe bent and 3 more"."""
    because: Sentence
    remedy: Sentence


class Known(Said):
    """One parameter, as far as it is known."""

    name: str
    words: str
    """ "zero of joint 6"."""
    u: Value
    drawn: Value
    """What a drawing knows it to."""
    determined: bool


class Meter(Said):
    """What is known after a touch."""

    line: Sentence
    """ "23 of 25 known · U(500 mm) 71 µm → goal 40 µm · about 18 touches more"."""
    touches: int
    determined: int
    determinable: int
    length_mm: float
    u_length: Value
    """U (k = 2) of a test length."""
    goal: Value | None
    reached: bool
    touches_more: int | None
    fresh_done: int | None
    """Of `fresh_places` that are held out; None: touches are fitted."""
    fresh_places: int | None
    lacking: list[Unknown]
    parameters: list[Known]


class WatchState(Said):
    """Of `watch`: nothing more than the stream itself."""

    kind: Literal["watch"]


class TouchState(Said):
    """Of `touch`."""

    kind: Literal["touch"]
    artefact: str
    features: list[str]
    by: str
    place: int
    held_out: bool
    touches: list[Touch]
    meter: Meter | None
    next: Next | None
    why_no_fit: Sentence | None


class Question(Said):
    """What is asked for now."""

    step: Literal["hold", "turn", "posture", "way"]
    sentence: Sentence
    lines: list[Sentence]
    joint: int | None
    """From 1; None: all of them."""
    found: list[Sentence]
    """What was found, where somebody is to say what becomes of it."""
    answers: list[Literal["yes", "again", "skip", "endless"]]
    """What one may say; empty where the arm answers by moving."""


class Bar(Said):
    """A channel, while a joint is turned."""

    channel: str
    raw: float
    moved_deg: float


class CommissionState(Said):
    """Of `commission`."""

    kind: Literal["commission"]
    question: Question | None
    """None: all is found."""
    steps: int
    steps_done: int
    bars: list[Bar]


class Point(Said):
    """A point that was taken."""

    name: str
    values: list[Value]
    """x, y, z."""


class Feature(Said):
    """What points became."""

    name: str
    kind: str
    points: list[str]
    wants: int
    """Points that it needs more."""
    values: list[tuple[str, Value]]
    why_not: Sentence | None


class TipNow(Said):
    """Where the tip is."""

    values: list[Value]
    """x, y, z; without numbers where they are not determined."""
    why_not: Sentence | None
    distance: Value | None
    to: str | None
    """Name of the point that the distance is to."""
    still: bool | None
    warnings: list[Sentence]


class MeasureState(Said):
    """Of `measure`."""

    kind: Literal["measure"]
    points: list[Point]
    features: list[Feature]
    kinds: list[str]
    """What touches can be made into."""
    by: str
    tip: TipNow | None
    remarks: list[Sentence]


State = Annotated[
    WatchState | CommissionState | TouchState | MeasureState | CheckState | TestState, Field(discriminator="kind")
]


class Stream(Said):
    """A source, now."""

    scheme: str
    """serial, tcp, virtual, …"""
    device: Sentence
    channels: list[str]
    rate_hz: float
    silent_s: float
    samples: int
    faults: dict[str, int]
    """By kind."""
    doubtful: bool
    ended: Sentence | None
    """Why it ended."""


class Activity(Said):
    """What is done with a stream."""

    id: Name
    kind: str
    arm: Sha256 | None
    """Of which the picture is."""
    virtual: bool
    """Whether its arm can be told to go somewhere."""
    running: bool
    begun: str
    """UTC."""
    who: Name
    """Who began it."""
    stream: Stream
    state: State
    said: list[Sentence]
    """The newest sentences."""
    left: list[Left]
    """What it left on the desk."""


class Left(Said):
    """A file that an activity left."""

    role: Literal[
        "arm",
        "plan",
        "source",
        "study",
        "result",
        "readings",
        "journal",
        "evaluation",
        "noise",
        "check",
        "test",
        "verification",
        "values",
    ]
    sha256: Sha256
    name: Name


class Unfinished(Said):
    """A session that was interrupted and can go on."""

    id: Name
    kind: str
    touches: int
    begun: str
    arm: Sha256
    plan: Sha256 | None
    """A plan or a study, a protocol, a test."""
    source: str


class Activities(Said):
    """What runs, and what was interrupted."""

    running: list[Activity]
    unfinished: list[Unfinished]


Activity.model_rebuild()
