"""What a session knows, as it goes over the wire."""

from __future__ import annotations

import math

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.directions import drawn
from ulna.ground.errors import UlnaInputError
from ulna.live.events import Happened, Meter
from ulna.live.lacking import Direction
from ulna.live.lacking_words import in_words, named_of, together
from ulna.live.running import RunningFit
from ulna.live.said import meter_line, next_lines
from ulna.live.session import SUSPICIOUS, Session
from ulna.live.touches import Touch, tips
from ulna.serve.activities.seen import bodies_of, in_degrees
from ulna.serve.contract import activities as wire
from ulna.serve.texts import length, uncertain


def meter_said(fit: RunningFit, meter: Meter) -> wire.Meter:
    """The meter."""
    so_far, worth, fresh = meter.so_far, meter.worth, meter.fresh
    return wire.Meter(
        line=meter_line(meter),
        touches=so_far.touches,
        determined=min(so_far.determined, meter.determinable),
        determinable=meter.determinable,
        length_mm=worth.length_mm,
        u_length=length(2.0 * worth.u_mm),
        goal=None if meter.goal_u_mm is None else length(2.0 * meter.goal_u_mm),
        reached=meter.goal_u_mm is not None and worth.u_mm <= meter.goal_u_mm,
        touches_more=meter.touches_more,
        fresh_done=None if fresh is None else fresh.done,
        fresh_places=None if fresh is None else fresh.places,
        lacking=[
            *_unknown("never", [each for each in meter.lacking.never if not each["frame"]]),
            *_unknown("not yet", meter.lacking.not_yet),
            *_unknown("weak", meter.lacking.weak),
        ],
        parameters=_parameters(fit, meter),
    )


def _unknown(head: str, directions: list[Direction]) -> list[wire.Unknown]:
    return [
        wire.Unknown(head=head, names=named_of(own), because=because, remedy=remedy)  # type: ignore[arg-type]
        for because, remedy, own in together(directions)
    ]


def _parameters(fit: RunningFit, meter: Meter) -> list[wire.Known]:
    u = np.sqrt(np.maximum(np.diag(meter.so_far.covariance), 0.0)).tolist()
    lost = set(meter.so_far.not_determined)
    units = dict(zip(fit.arm.parameter_names, fit.arm.parameter_units, strict=True))
    return [
        wire.Known(
            name=name,
            words=in_words(name),
            u=uncertain(each, units.get(name, "mm")),
            drawn=uncertain(_drawn(name), units.get(name, "mm")),
            determined=name not in lost,
        )
        for name, each in zip(fit.names, u, strict=True)
    ]


def _drawn(name: str) -> float:
    """What a drawing may be off; of an artefact's dimension that is fitted nobody has said."""
    try:
        return drawn(name)
    except (KeyError, UlnaInputError):
        return math.nan


def next_said(arm: Arm, meter: Meter) -> wire.Next:
    """Where to touch next."""
    found = meter.next
    x, y, z = found.point_mm.tolist()
    return wire.Next(
        sentences=next_lines(meter),
        feature=found.name,
        here=found.here,
        point_mm=(x, y, z),
        places_mm=found.stand.points_mm.tolist(),
        lies=found.stand.lies,
        slope_deg=found.stand.slope_deg,
        azimuth_deg=found.stand.azimuth_deg,
        elbow=found.elbow,
        comes_from=found.comes_from,
        q_deg=in_degrees(arm, found.q_rad),
        bodies=bodies_of(arm, found.q_rad),
    )


def touch_said(session: Session, touch: Touch, told: Happened | None) -> wire.Touch:
    """A touch; told: what was said of it when it was taken."""
    names = list(session.spec.artefact.features)
    x, y, z = tips(session.arm_now, [touch])[0].tolist()
    off_mm = None if told is None else told.off_mm
    times = None if told is None else told.times
    return wire.Touch(
        number=touch.number,
        feature=names[touch.feature] if touch.feature < len(names) else "",
        place=touch.standing,
        held_out=touch.held_out,
        withdrawn=touch.withdrawn,
        tip_mm=(x, y, z),
        spread=length(touch.spread_mm),
        off=None if off_mm is None else length(off_mm),
        times=times,
        suspicious=times is not None and times > SUSPICIOUS,
    )
