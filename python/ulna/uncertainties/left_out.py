"""What is not in the figures of an uncertainty, in words."""

from __future__ import annotations

from ulna.arm.arm import Arm
from ulna.arm.conditions import TEMPERATURE
from ulna.arm.effects.effects import EFFECTS
from ulna.arm.reading_noise import ReadingNoise


def left_out(
    arm: Arm, noise: ReadingNoise, u_temperature_k: float, exact: list[str], more: tuple[str, ...] = ()
) -> list[str]:
    """What nobody stated or the arm's model has not; exact: parameters that count so; more: of what is measured."""
    left = []
    if exact:
        left.append(f"parameters that the calibration held, which count as exact: {', '.join(exact)}")
    if noise.encoder_rad is None and not noise.estimated:
        left.append("the encoders' noise while measuring: nobody stated it")
    if noise.seat_mm is None:
        left.append("how well a touch finds its place (a seat, a surface): nobody stated it")
    if TEMPERATURE in arm.needs and not u_temperature_k:
        left.append("the uncertainty of the temperature: nobody stated it")
    absent = [effect.left_out for effect in EFFECTS.values() if effect not in arm.effects and not effect.of_first]
    if noise.estimated or noise.unexplained_mm > 0.0:
        left.append(
            "how a touch's scatter changes over the volume: that of the calibration's touches counts everywhere"
        )
        if absent:
            beyond = "what the arm's model has not, beyond what it added to the scatter of the calibration's touches"
            left.append(f"{beyond}: {', '.join(absent)}")
    else:
        left += [f"{each}: the arm's model has none" for each in absent]
    left += more
    left.append("the form and the temperature of what is measured")
    left.append("errors of the calibration's artefact beyond the u that its study states")
    return left
