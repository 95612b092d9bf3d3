"""Combinations of parameters that readings leave open: how far each may go, and which of its parameters to name."""

from __future__ import annotations

from collections.abc import Mapping

from ulna.arm.effects.effects import EFFECTS, extra_of

DRAWN_MM, DRAWN_RAD = 1.0, 0.01
DRAWN = {"mm": DRAWN_MM, "rad": DRAWN_RAD}
"""What may be of geometry before anybody has measured: what a drawing says; effects know their own."""

NEXT_TO_NOTHING = 1e-3
"""Of the largest step of a combination, in what may be of each: a smaller one is not named."""


def unit_of(parameter: str) -> str:
    """ "rad", "mm", "1/K", "rad/(N m)" or "1", by the parameter's name."""
    extra = extra_of(parameter)
    if extra is not None:
        return EFFECTS[extra].unit
    angle = parameter.startswith("joint.") and parameter.rsplit(".", 1)[-1] in ("theta0", "alpha", "beta")
    return "rad" if angle else "mm"


def drawn(parameter: str) -> float:
    """What may be of a parameter before anybody has measured, in its unit."""
    extra = extra_of(parameter)
    return DRAWN[unit_of(parameter)] if extra is None else EFFECTS[extra].drawn


def steps(combination: Mapping[str, float]) -> dict[str, float]:
    """Sizes of a combination's steps, in what may be of each parameter."""
    return {name: abs(weight) / drawn(name) for name, weight in combination.items()}


def worth_naming(combination: Mapping[str, float]) -> dict[str, float]:
    """The combination without those parameters that it moves by next to nothing."""
    sizes = steps(combination)
    least = NEXT_TO_NOTHING * max(sizes.values())
    return {name: weight for name, weight in combination.items() if sizes[name] >= least}


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


def sentence(text: str) -> str:
    """With a full stop; the core's reasons are clauses."""
    return text if text.endswith(".") else f"{text}."


def _step(weight: float) -> str:
    return f"{weight:+.3g}".replace("-", "−").replace("e−0", "e−")
