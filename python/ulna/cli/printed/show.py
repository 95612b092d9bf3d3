"""What `ulna show` says: where the page is, where the tip is, what to look for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from ulna.arm.frames.bodies import pictured
from ulna.ground.arrays import F64
from ulna.ground.digits import fixed
from ulna.pictures.scene import Scene


def lines(target: Path, scene: Scene, q_rad: F64, remarks: Sequence[str]) -> Iterator[str]:
    """In their order; what needs care comes last."""
    arm = scene.arm
    x, y, z = (fixed(value, 3) for value in scene.tip_mm(q_rad).tolist())
    yield f"Written: {target} ('{arm.name}', {arm.n} joints, probe '{scene.probe}')"
    yield f"In its first pose the tip is at x = {x}, y = {y}, z = {z} mm."
    yield (
        "Set the sliders to what your encoders show and compare axis by axis: where axis k + 1 points another way, "
        "alpha of joint k is wrong; where a joint turns the other way, its sign."
    )
    if len(arm.probes) > 1:
        yield f"note: the arm has the probes {', '.join(arm.probes)}; choose one with --probe."
    unseen = [effect.words for effect in arm.effects if not pictured(effect, arm)]
    if unseen:
        yield f"note: not in the picture: {', '.join(unseen)}."
    unknown = [str(k) for k, joint in enumerate(arm.joints, start=1) if joint.sign == 0]
    if unknown:
        yield f"note: nobody knows which way joint {', '.join(unknown)} counts; drawn with sign = 1."
    for k, (joint, q) in enumerate(zip(arm.joints, q_rad.tolist(), strict=True), start=1):
        low, high = joint.limits_rad or (q, q)
        if not low - 1e-9 <= q <= high + 1e-9:
            yield f"note: joint {k} begins beyond its limits."
    for remark in remarks:
        yield f"note: {remark}"
