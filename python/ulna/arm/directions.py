"""Combinations of parameters that readings leave open: how far each may go, and which of its parameters to name."""

from __future__ import annotations

from collections.abc import Mapping

from ulna.arm.effects.effects import extra_of

DRAWN_MM, DRAWN_RAD = 1.0, 0.01
DRAWN = {"mm": DRAWN_MM, "rad": DRAWN_RAD, "1/K": 3e-5, "rad/(N m)": 1e-3}
"""What may be of each unit before anybody has measured: a drawing, a material, a bearing."""

NEXT_TO_NOTHING = 1e-3
"""Of the largest step of a combination, in what may be of each: a smaller one is not named."""


def unit_of(parameter: str) -> str:
    """ "rad", "mm", "1/K" or "rad/(N m)", by the parameter's name."""
    if parameter.startswith("joint."):
        own = {"theta0": "rad", "alpha": "rad", "beta": "rad", "expansion": "1/K", "compliance": "rad/(N m)"}
        return own.get(parameter.rsplit(".", 1)[-1], "rad" if extra_of(parameter) else "mm")
    return "mm"


def steps(combination: Mapping[str, float]) -> dict[str, float]:
    """Sizes of a combination's steps, in what may be of each parameter."""
    return {name: abs(weight) / DRAWN[unit_of(name)] for name, weight in combination.items()}


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
