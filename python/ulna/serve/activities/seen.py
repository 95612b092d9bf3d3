"""An arm as it is drawn: where its bodies and its tip are in a posture, and how sure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.frames.bodies import bodies
from ulna.ground.arrays import F64
from ulna.live.figures import Calibrated
from ulna.live.postures import near_stops
from ulna.serve.contract.arms import Bodies
from ulna.serve.frames import Flag, Newest


@dataclass(frozen=True)
class Seen:
    """How one is drawn."""

    arm: Arm | None
    """None: of a stream of which nobody knows it."""
    probe: int = 0

    def newest(
        self, t_s: float, q_rad: F64, doubtful: bool, rests: float = 0.0, covariance_mm2: F64 | None = None
    ) -> Newest:
        """What is packed. covariance_mm2: (6,) of the tip; None where none is known."""
        flags = Flag.DOUBTFUL if doubtful else Flag(0)
        if rests >= 1.0:
            flags |= Flag.STILL
        if self.arm is None or len(q_rad) != self.arm.n:
            return Newest(t_s, q_rad, np.zeros(3), np.zeros(6), rests, np.zeros((len(q_rad) + 1, 3, 4)), flags)
        flags |= Flag.ARM
        if near_stops(self.arm, q_rad):
            flags |= Flag.AT_STOP
        if covariance_mm2 is None:
            flags |= Flag.NOT_DETERMINED
            covariance_mm2 = np.zeros(6)
        tip_mm = self.arm.core.tip(np.ascontiguousarray(q_rad[None]), self.probe)[0]
        stand = np.array(bodies(self.arm, q_rad))[:, :3, :]
        return Newest(t_s, q_rad, tip_mm, covariance_mm2, rests, stand, flags)


def tip_covariance(calibrated: Calibrated, q_rad: F64) -> F64 | None:
    """(6,) mm² of the tip in a posture, from the calibrated parameters; None where nobody knows."""
    arm, known = calibrated.arm, calibrated.arm.uncertainty
    if known is None or calibrated.without is not None:
        return None
    columns = np.array([arm.parameter_names.index(name) for name in known.names], dtype=np.int64)
    pose, probe = np.ascontiguousarray(q_rad[None]), arm.probe_index(calibrated.probe)
    found: F64 = arm.core.tip_covariance(pose, probe, columns, known.matrix, **calibrated.conditions)[0]
    return found


def bodies_of(arm: Arm, q_rad: F64, probe: int = 0) -> Bodies:
    """The same as JSON has it."""
    stand = np.array(bodies(arm, q_rad))[:, :3, :].reshape(-1, 12)
    x, y, z = arm.core.tip(np.ascontiguousarray(q_rad[None]), probe)[0].tolist()
    return Bodies(bodies=stand.tolist(), tip_mm=(x, y, z))


def in_degrees(arm: Arm, q_rad: F64) -> list[float]:
    """Angles as people read them; joints that slide stay in mm."""
    shown: list[float] = np.where(arm.slides, q_rad, np.degrees(q_rad)).tolist()
    return shown


def from_degrees(arm: Arm, q_deg: list[float]) -> F64:
    """The other way."""
    given = np.array(q_deg, dtype=np.float64)
    found: F64 = np.where(arm.slides, given, np.radians(given))
    return found
