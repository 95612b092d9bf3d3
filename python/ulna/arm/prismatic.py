"""What a joint that slides cannot have: all that goes with an angle."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ulna.arm.effects.effects import EFFECTS, Effects
from ulna.ground.errors import UlnaInputError


def check_prismatic(table: Any, own: Effects, number: int, path: Path) -> None:
    """A joint's table with type = "prismatic". Raises UlnaInputError for a key that only a joint has that turns."""
    key = f"{path}: key 'joint.{number}"
    if table.limits is None:
        raise UlnaInputError(
            f"{key}.limits' is missing: joint {number} is prismatic; expected how far it slides, [lowest, highest], in "
            "the file's unit of length. Add it."
        )
    turning = {
        "model": table.model if table.model != "dh" else None,
        "endless": table.endless or None,
        "counts_per_turn": table.counts_per_turn,
        "sign": 0 if table.sign == 0 else None,
    }
    for name, value in turning.items():
        if value is not None:
            expected = "1 or -1: a calibration does not find which way it counts" if name == "sign" else "no such key"
            raise UlnaInputError(
                f"{key}.{name}': got {value!r}, but joint {number} is prismatic; expected {expected}. Correct it, or "
                'set type = "rotary".'
            )
    for effect in EFFECTS.values():
        # zeros stand in files of calibrated arms, and are nothing; a weight is what other joints carry
        said = {name: value for name, value in effect.written(own).items() if name not in ("mass", "centre")}
        if effect.of_turn and _says_something(said):
            raise UlnaInputError(
                f"{key}': joint {number} is prismatic, and what it does beyond its geometry ('{effect.name}') is of "
                f"joints that turn; expected none of {', '.join(effect.table.model_fields)}. Remove it."
            )


def _says_something(value: Any) -> bool:
    if isinstance(value, dict | list | tuple):
        return any(map(_says_something, value.values() if isinstance(value, dict) else value))
    return bool(value)
