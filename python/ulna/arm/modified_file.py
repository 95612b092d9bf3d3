"""Joint tables of an arm file in the modified Denavit–Hartenberg form: what they must and cannot have."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ulna.arm.effects.effects import EFFECTS
from ulna.ground.errors import UlnaInputError

if TYPE_CHECKING:
    from ulna.arm.tables import ArmFile


def check_modified(file: ArmFile, path: Path) -> None:
    """Every joint has theta0, alpha, a, d; none is a Hayati joint; the base stands on axis 1. Raises UlnaInputError."""
    if file.full_last_link:
        raise UlnaInputError(
            f"{path}: key 'full_last_link': goes with convention = \"dh\" only; expected no such key in a modified "
            "table, whose last row becomes part of the tip. Remove it, or write the arm in the other form."
        )
    for k, joint in enumerate(file.joint, start=1):
        for effect in EFFECTS.values():
            effect.check_modified(joint, f"joint.{k}", path)
        if joint.model == "hayati" or joint.beta:
            got = "model': got 'hayati'" if joint.model == "hayati" else f"beta': got {joint.beta:g}"
            raise UlnaInputError(
                f"{path}: key 'joint.{k}.{got}, which the modified form does not have; expected joints "
                'with theta0, alpha, a and d only. Write the arm with convention = "dh", in which a joint may be a '
                "Hayati joint (ulna import dh turns parallel axes into such)."
            )
        for key in ("theta0", "alpha", "a", "d"):
            if getattr(joint, key) is None:
                raise UlnaInputError(
                    f"{path}: key 'joint.{k}.{key}' is missing; expected theta0, alpha, a and d of every joint, with "
                    'convention = "modified-dh" of the last one too. Add it (0 where the table says nothing).'
                )
    first = file.joint[0]
    for key, value in (("alpha", first.alpha), ("a", first.a)):
        if value:
            # A remark would do for lengths, but coordinates in the base frame would quietly be others.
            raise UlnaInputError(
                f"{path}: key 'joint.1.{key}': got {value:g}, but before joint 1 alpha and a only place the table's "
                "base frame, and Ulna's stands on axis 1; expected 0. Set both to 0: points are then measured in the "
                "frame on axis 1, and come into the table's by a shift a along x and a turn alpha about x."
            )
