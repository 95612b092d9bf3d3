"""How a target is mounted on the last link, and how the instrument that sees it stands: R(q) M = F R_m.

The start is that of turns: between two readings of one standing R_aᵀ R_b M = M (R_mᵀ R_m'), so M takes the axes of the
turns that the instrument saw to those that the arm made (Park and Martin 1994). From there M and the F of all standings
take turns, each the best for the others, until nothing moves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.geometry.rigid import rotations
from ulna.geometry.rotation import vectors_of_matrices
from ulna.ground.arrays import F64, I64

_MOST_ROUNDS = 200
_STILL_RAD = 1e-12
_HALF_TURN_RAD = 3.0
"""Beyond this the axis of a turn is not told from its opposite."""


@dataclass(frozen=True)
class Mounting:
    """What fits best."""

    mount: F64
    """(3, 3) M: from the target's frame to the probe's."""
    frames: F64
    """(S, 3, 3) F of each standing: from the instrument's frame to the base frame."""

    def off_rad(self, held: F64, seen: F64, code: I64) -> F64:
        """(N, 3) rotation vectors, base frame: what each reading is off by."""
        return vectors_of_matrices(held @ self.mount @ np.swapaxes(self.frames[code] @ seen, 1, 2))


def mounting(held: F64, seen: F64, code: I64, free: bool, mount: F64 | None = None) -> Mounting:
    """The mount and the frames that fit best.

    held: (N, 3, 3) R(q); seen: (N, 3, 3) R_m; code: (N,) the standing of each, from 0; free: whether standings have
    frames of their own, else the instrument's is the base frame; mount: (3, 3) where it is known.
    """
    standings = [np.flatnonzero(code == number) for number in range(int(code.max()) + 1)]
    frames = np.tile(np.eye(3), (len(standings), 1, 1))
    known = mount is not None
    found = mount if mount is not None else (_by_turns(held, seen, standings) if free else _best(held, seen))
    for _ in range(_MOST_ROUNDS):
        if free:
            turned = held @ found @ np.swapaxes(seen, 1, 2)
            frames = rotations(np.stack([turned[rows].sum(axis=0) for rows in standings]))
        if known:
            break
        better = _best(held, frames[code] @ seen)
        moved = float(np.linalg.norm(better - found))
        found = better
        if not free or moved < _STILL_RAD:
            break
    return Mounting(found, frames)


def _best(held: F64, seen: F64) -> F64:
    """M of targets seen from the base frame."""
    return _nearest((np.swapaxes(held, 1, 2) @ seen).sum(axis=0))


def _by_turns(held: F64, seen: F64, standings: list[I64]) -> F64:
    made, saw = [np.empty((0, 3))], [np.empty((0, 3))]
    for rows in standings:
        for step in {1, max(1, len(rows) // 2)}:
            others = np.roll(rows, step)
            made.append(vectors_of_matrices(np.swapaxes(held[others], 1, 2) @ held[rows]))
            saw.append(vectors_of_matrices(np.swapaxes(seen[others], 1, 2) @ seen[rows]))
    by_arm, by_eye = np.concatenate(made), np.concatenate(saw)
    sure = (np.linalg.norm(by_arm, axis=1) < _HALF_TURN_RAD) & (np.linalg.norm(by_eye, axis=1) < _HALF_TURN_RAD)
    return _nearest(by_arm[sure].T @ by_eye[sure])


def _nearest(cross: F64) -> F64:
    """(3, 3): the rotation of one set."""
    found: F64 = rotations(cross[None])[0]
    return found
