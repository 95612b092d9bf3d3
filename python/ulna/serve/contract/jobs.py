"""Long work: begun, watched, cancelled. A kind of job is a row of `BeginJob`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Asked, Name, Problem, Said, Sentence, Sha256

Beside = Annotated[list[Sha256], Field(max_length=50, default_factory=list)]
"""Files of the desk that it names: they are laid beside it, by their names."""


class BeginCalibrate(Asked):
    """A study to a calibrated arm."""

    kind: Literal["calibrate"]
    study: Sha256
    beside: Beside


class BeginReport(Asked):
    """The report of a result, one HTML file."""

    kind: Literal["report"]
    result: Sha256
    language: Literal["en", "de", "zh"] = "en"


class BeginPlan(Asked):
    """Places, postures and their order, as `ulna plan` chooses them."""

    kind: Literal["plan"]
    arm: Sha256
    plan: Sha256
    anywhere: bool = False
    """Wherever the arm reaches: below the table and overhead too."""
    language: Literal["en", "de", "zh"] = "en"
    """Of the work sheet."""


class BeginCheck(Asked):
    """A few touches before work, by a protocol."""

    kind: Literal["check"]
    protocol: Sha256
    readings: Sha256
    """A table of touches."""
    arm: Sha256 | None = None
    """In place of the arm that the protocol names."""
    beside: Beside
    of: Name | None = None
    """The arm in the record: its earlier checks by this protocol are the history."""
    history: Annotated[list[Sha256], Field(max_length=500, default_factory=list)]
    """Earlier checks of the desk."""
    date: Annotated[str, Field(min_length=4, max_length=40)] | None = None
    """When it was measured; None: now."""
    operator: Name | None = None


class BeginVerify(Asked):
    """An acceptance test, from its verify file."""

    kind: Literal["verify"]
    test: Sha256
    """A verify file."""
    arm: Sha256 | None = None
    """For encoder readings."""
    beside: Beside
    """Its readings, and a profile of one's own."""


class BeginCertificate(Asked):
    """A draft of a certificate; POST /records/issue makes one that counts."""

    kind: Literal["certificate"]
    result: Sha256
    laboratory: Sha256
    verification: Annotated[list[Sha256], Field(max_length=20, default_factory=list)]
    """Acceptance tests of the same arm."""
    beside: Beside
    """A logo."""
    form: Literal["pdf", "dcc"] = "pdf"
    language: Literal["en", "de", "zh"] = "en"
    annex: bool = False
    """Of the PDF: with how the fit went."""


BeginJob = Annotated[
    BeginCalibrate | BeginReport | BeginPlan | BeginCheck | BeginVerify | BeginCertificate,
    Field(discriminator="kind"),
]


class Made(Said):
    """A file that a job made, on the desk."""

    role: str
    sha256: Sha256
    name: Name


class Job(Said):
    """One."""

    id: Name
    kind: str
    title: Sentence
    who: Name
    """Who began it."""
    state: Literal["waiting", "running", "done", "failed", "cancelled"]
    stage: Sentence
    done: int
    total: int
    """0: not known."""
    made: list[Made]
    said: list[Sentence]
    """What is to be known of what it made."""
    problem: Problem | None


class Jobs(Said):
    """All since the server began, the newest first."""

    jobs: list[Job]
