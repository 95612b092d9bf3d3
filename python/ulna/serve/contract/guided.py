"""A check or an acceptance test that is touched step by step: how it begins, how it stands, what is asked before."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Asked, Name, Said, Sentence, Sha256, Value
from ulna.serve.contract.plans import Amount, Positive
from ulna.serve.contract.sources import Source

By = Literal["key", "button", "still"]
TestedState = Literal["as-found", "as-left"]

# ------------------------------------------------------------ how one begins


class BeginCheckTouches(Asked):
    """A check before work, step by step."""

    kind: Literal["check"]
    source: Source
    arm: Sha256
    """A result, or an arm file: it turns readings into points."""
    protocol: Sha256
    of: Name | None = None
    """The arm in the record: its earlier checks by this protocol are the history."""
    operator: Name | None = None
    probe: Name | None = None
    """Of an arm with several."""
    by: By = "still"
    go_on: Name | None = None
    """The id of an interrupted one that goes on, as it was asked for."""


class BeginTestTouches(Asked):
    """An acceptance test, step by step; as found comes before as left."""

    kind: Literal["test"]
    source: Source
    arm: Sha256
    test: Sha256
    """A verify file; the tables that it names for this state are yet to be touched."""
    state: TestedState = "as-left"
    beside: Annotated[list[Sha256], Field(max_length=50, default_factory=list)]
    """A profile of one's own, tables of a state that was touched before."""
    probe: Name | None = None
    by: By = "still"
    go_on: Name | None = None


# ------------------------------------------------------------ how it stands


class Labelled(Said):
    """Which measurement: "" where nothing needs to be said."""

    test: str
    kind: str
    """length, sphere, single-point, …"""
    artefact: str
    position: str
    orientation: str
    repeat: str


class StepNow(Labelled):
    """What is to be touched."""

    number: int
    """From 1."""
    feature: str
    now: int
    """Which touch of `all` of this feature in this measurement."""
    all: int
    what: Sentence
    """In the words of the list."""


class FigureNow(Said):
    """A value of a figure, as soon as it is known."""

    test: str
    key: str
    """Its short name."""
    name: Sentence
    of: list[tuple[str, str]]
    value: Value
    limit: Value | None
    guard: Value | None
    """The guard band about the limit."""
    verdict: str | None
    why: Sentence | None
    """Why there is none."""


class Part(Labelled):
    """One measurement: touches that belong together."""

    first: int
    """Number of its first step."""
    touched: int
    touches: int
    figures: list[FigureNow]
    verdict: str | None
    """The worst of them."""


class StepTouch(Said):
    """A touch that was taken."""

    number: int
    step: int
    feature: str
    place: str
    spread: Value
    scatter: Value | None
    """Of all touches in this seat so far, per coordinate; None of one alone."""
    withdrawn: str | None


class NotYet(Said):
    """Why what was touched gives no figure yet."""

    test: str
    why: Sentence


class StepsState(Said):
    """Of both."""

    name: str
    """Of the protocol, or the profile."""
    decision: Sentence
    """When a value passes."""
    by: By
    steps: int
    done: int
    present: StepNow | None
    """None: all is touched."""
    parts: list[Part]
    overall: list[FigureNow]
    """Of several measurements together."""
    not_yet: list[NotYet]
    touches: list[StepTouch]
    """The newest."""
    follows: bool
    """Whether the virtual hand does what is asked for."""


class CheckState(StepsState):
    """Of `check`."""

    kind: Literal["check"]


class TestState(StepsState):
    """Of `test`."""

    kind: Literal["test"]
    state: TestedState


# ------------------------------------------------------------ what a test asks for, before


class LimitAsked(Asked):
    """A maximum permissible error: a, or a + L / b."""

    figure: Name
    a_mm: Positive
    b: Positive | None = None


class CertifiedAsked(Asked):
    """An artefact as its certificate states it."""

    name: Name
    """As the profile's list calls it."""
    size_mm: Positive
    """Length or diameter."""
    u_mm: Amount
    """Standard uncertainty."""
    form_mm: Amount | None = None
    expansion: Annotated[float, Field(ge=0, le=1)] | None = None
    """1/K"""
    u_expansion: Annotated[float, Field(ge=0, le=1)] | None = None


class TestAsked(Asked):
    """A test plan, as `ulna verify --make-plan` makes it, with what is known filled in."""

    profile: Name
    """One that comes with Ulna, or the SHA-256 of one's own."""
    arm: Sha256
    as_found: bool = False
    """Whether the arm is tested as found too, before anything is done to it."""
    item: Name | None = None
    """What reports call the arm; None: as its file does."""
    range_mm: Positive | None = None
    """Diameter of the measuring range; None: as of such an arm."""
    limits: Annotated[list[LimitAsked], Field(max_length=50, default_factory=list)]
    artefacts: Annotated[list[CertifiedAsked], Field(max_length=50, default_factory=list)]
    temperature_c: Annotated[float, Field(ge=-50, le=100)] | None = None
    u_temperature_k: Amount | None = None
    fixture_mm: Amount | None = None


class TestPlanMade(Said):
    """What was made."""

    test: Sha256
    beside: list[Sha256]
    """A profile of one's own."""
    name: Name
    touches: int
    """Of each state."""
    lacks: list[Sentence]
    """What is to be filled in before it can be touched."""


class ProfileInfo(Said):
    """A profile that comes with Ulna."""

    name: Name
    standard: str
    touches: int


class Profiles(Said):
    """All of them."""

    profiles: list[ProfileInfo]


class WantedArtefact(Said):
    """An artefact that a profile asks for; the numbers are an example for an arm of this reach."""

    name: Name
    kind: str
    """ball or length."""
    size_mm: float
    u_mm: float
    form_mm: float | None
    expansion: float
    u_expansion: float


class WantedLimit(Said):
    """A figure that a profile gives; the limit is an example, of no maker."""

    figure: Name
    name: Sentence
    a_mm: float | None
    b: float | None


class ProfileWants(Said):
    """What a profile asks of a test with an arm."""

    name: Name
    standard: str
    statement: Sentence
    touches: int
    range_mm: float
    artefacts: list[WantedArtefact]
    limits: list[WantedLimit]


class PlayGuided(Said):
    """A virtual arm as it truly is, a protocol and a short test, ready to be tried."""

    arm: Sha256
    source: str
    protocol: Sha256
    test: Sha256
    beside: list[Sha256]
