"""Arms: drawings and calibrated ones, and how they look."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Asked, Name, Said, Sentence, Sha256, Value


class Joint(Said):
    """One joint, from the base."""

    number: int
    name: str | None
    slides: bool
    sign: Literal[-1, 0, 1]
    """0: nobody knows yet which way its encoder counts."""
    low_deg: float
    high_deg: float
    """How far a slider goes: the travel, or half a turn each way. Of a joint that slides, mm."""
    endless: bool
    counts_per_turn: float | None


class Parameter(Said):
    """One parameter of the model."""

    name: str
    value: Value
    status: Literal["drawing", "fitted", "held", "not determined"]


class Shape(Said):
    """One thing to draw, fixed to a body; points in its frame, mm."""

    kind: Literal["line", "solid", "face", "ball", "word"]
    body: int
    group: Literal["floor", "arm", "axes", "frames", "dimensions"]
    role: str
    points_mm: list[tuple[float, float, float]]
    joint: int
    text: str
    radius_mm: float


class Scene(Said):
    """How an arm looks."""

    shapes: list[Shape]
    reach_mm: float
    step_mm: float
    """Between the lines of the floor."""
    q_deg: list[float]
    """A posture to show it in."""
    bodies: Bodies
    """In that posture."""


Row = Annotated[list[float], Field(min_length=12, max_length=12)]
"""A body's frame in the base frame: the upper three rows of its 4 × 4 matrix, row by row, mm."""


class Bodies(Said):
    """Where the bodies are: the base, then what turns with each joint; and the tip."""

    bodies: list[Row]
    tip_mm: tuple[float, float, float]


class Posture(Asked):
    """Encoder angles, degrees (of joints that slide, mm)."""

    q_deg: Annotated[list[float], Field(min_length=1, max_length=16)]
    probe: Name | None = None


class Calibration(Said):
    """What is said of a calibrated arm in one line."""

    at: str | None
    """UTC."""
    converged: bool
    verdict: Sentence
    readings: int
    u_length: Value | None
    """U (k = 2) of a length, where it was asked for."""


class ArmInfo(Said):
    """An arm of the desk."""

    sha256: Sha256
    name: str
    file: Name
    joints: list[Joint]
    probes: list[str]
    calibration: Calibration | None
    """None: a drawing."""


class ArmWhole(Said):
    """The same with its parameters and its picture."""

    arm: ArmInfo
    parameters: list[Parameter]
    scene: Scene


class Arms(Said):
    """All of them, the newest first."""

    arms: list[ArmInfo]


Scene.model_rebuild()
