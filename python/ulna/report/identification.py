"""What readings determine, in words: lost and weak directions with cause and remedy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import RenderableType
from rich.padding import Padding
from rich.text import Text

from ulna.directions import unit_of, worth_naming
from ulna.identify import Identification
from ulna.model import Arm
from ulna.report.digits import uncertainty
from ulna.report.tables import heading, listed

_CAUSES = {
    "base-frame": "the base frame",
    "scale": "the scale",
    "probe-on-axis": "a tip on the last axis",
    "probe-unused": "a probe that no reading uses",
    "joint-still": "a joint that does not move",
    "parallel-axes": "parallel axes",
    "redundant-link": "a link that says what the tip says",
    "approach-unknown": "an approach that nobody stated",
    "approach-one-sided": "an approach from one side alone",
    "temperature-still": "a temperature that does not change",
    "no-moment": "gravity along an axis",
    "coverage": "the choice of poses",
}


def identification_report(found: Identification, arm: Arm) -> list[RenderableType]:
    """All of `ulna identify`."""
    return [Text(f"{arm.name}, {arm.n} joints: {determined_in_words(found)}"), *directions(found)]


def determined_in_words(found: Identification) -> str:
    """One sentence with the counts."""
    if found.determined == found.parameters:
        return f"the readings determine all {found.parameters} free parameters."
    lost = found.parameters - found.determined
    return (
        f"the readings determine {found.determined} of {found.parameters} free parameters; "
        f"{lost} combination{' is' if lost == 1 else 's are'} lost."
    )


def directions(found: Identification) -> list[RenderableType]:
    """Lost directions, then weak ones; nothing where there are none."""
    parts: list[RenderableType] = []
    if found.lost:
        parts += ["", heading("Not determined")]
        parts.append(listed(_lost(direction) for direction in found.lost))
    if found.weak:
        parts += ["", heading("Determined, but worse than an arm is known from its drawing")]
        parts.append(listed(_weak(direction) for direction in found.weak))
    if found.from_prior:
        parts += ["", heading("Known from their priors; the readings say next to nothing of them")]
        parts.append(Padding(Text(", ".join(found.from_prior)), (0, 0, 0, 1)))
    return parts


def _lost(direction: Mapping[str, Any]) -> Sequence[str]:
    cause = _CAUSES.get(direction.get("cause", ""), direction.get("cause", ""))
    frame = " No length or shape depends on it." if direction.get("frame") else ""
    return (
        f"{combination(direction['combination'])}{f'   ({cause})' if cause else ''}",
        f"Why: {sentence(direction['because'])}{frame}",
        f"Remedy: {sentence(direction['remedy'])}",
    )


def _weak(direction: Mapping[str, Any]) -> Sequence[str]:
    return (
        f"{combination(direction['combination'])}   (u = {uncertainty(direction['u'])} {direction['unit']})",
        f"Why: {sentence(direction['because'])}",
        f"Remedy: {sentence(direction['remedy'])}",
    )


def sentence(text: str) -> str:
    """With a full stop; the core's reasons are clauses."""
    return text if text.endswith(".") else f"{text}."


def combination(weights: Mapping[str, float]) -> str:
    """One parameter by its name; several with the steps, in rad and mm, that together change no residual."""
    if len(weights) == 1:
        return next(iter(weights))
    ordered = sorted(worth_naming(weights).items(), key=lambda item: -abs(item[1]))
    unnamed = len(weights) - len(ordered)
    return (
        "together: "
        + ", ".join(f"{name} {_step(weight)} {unit_of(name)}" for name, weight in ordered)
        + (f", and {unnamed} more by next to nothing" if unnamed else "")
    )


def _step(weight: float) -> str:
    return f"{weight:+.3g}".replace("-", "−").replace("e−0", "e−")
