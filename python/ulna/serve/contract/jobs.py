"""Long work: begun, watched, cancelled. A kind of job is a row of `BeginJob`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Asked, Name, Problem, Said, Sentence, Sha256


class BeginCalibrate(Asked):
    """A study to a calibrated arm."""

    kind: Literal["calibrate"]
    study: Sha256


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


BeginJob = Annotated[BeginCalibrate | BeginReport | BeginPlan, Field(discriminator="kind")]


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
    state: Literal["waiting", "running", "done", "failed", "cancelled"]
    stage: str
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
