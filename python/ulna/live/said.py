"""What a session says, in sentences and as JSON: one line of what is known, what to do next, what happened."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from ulna.ground.errors import for_people
from ulna.live.events import Event, Happened, Meter
from ulna.live.faults import Fault
from ulna.live.session import SUSPICIOUS
from ulna.live.touches import as_dict
from ulna.live.trigger import Refused

AGAIN = 2
"""So often in a row an artefact is not moved by whoever was asked to leave it."""
BEGIN_AGAIN = "raise known_angle in it (0.09 rad where zeros are by eye), and begin again."


def meter_line(meter: Meter) -> str:
    """ "23 of 25 known · U(500 mm) 71 µm → goal 40 µm · about 18 touches more"."""
    known = min(meter.so_far.determined, meter.determinable)
    worth = meter.worth
    line = f"{known} of {meter.determinable} known · U({worth.length_mm:.0f} mm) {length_said(2.0 * worth.u_mm)}"
    if meter.fresh is not None:
        return (
            f"{line} · fresh place {min(meter.fresh.done + 1, meter.fresh.places)} of {meter.fresh.places}, not fitted"
        )
    if meter.goal_u_mm is None:
        return line
    goal = length_said(2.0 * meter.goal_u_mm)
    if worth.u_mm <= meter.goal_u_mm:
        return f"{line}: goal {goal} reached"
    more = "" if meter.touches_more is None else f" · about {meter.touches_more} touches more"
    return f"{line} → goal {goal}{more}"


def next_lines(meter: Meter) -> list[str]:
    """Where to touch next, as one says it to somebody."""
    suggestion = meter.next
    what = f"touch {for_people(suggestion.name)}" if suggestion.name else "touch it"
    held = [f"elbow {suggestion.elbow}"] if suggestion.elbow else []
    how = ", ".join([what, *held, f"probe from {suggestion.comes_from}"])
    if suggestion.here:
        return [f"Next, where it stands: {how}"]
    x, y, z = suggestion.stand.points_mm.mean(axis=0)
    stand = suggestion.stand
    steep = f" {abs(stand.slope_deg):.0f}°" if stand.lies in ("rising", "falling") else ""
    lies = "" if stand.lies == "nowhere" else f", {stand.lies}{steep}, towards {stand.azimuth_deg:.0f}°"
    return [f"Next, put it at x {x:.0f}, y {y:.0f}, z {z:.0f} mm{lies}:", f"  {how}"]


def meter_lines(meter: Meter) -> list[str]:
    """Both."""
    return [meter_line(meter), *next_lines(meter)]


def happened_lines(happened: Happened, names: list[str]) -> list[str]:
    """A touch that was taken, and what is odd about it."""
    touch = happened.touch
    feature = f", {for_people(names[touch.feature])}" if touch.feature < len(names) else ""
    fresh = "fresh " if touch.held_out else ""
    said = f"Touch {touch.number}{feature} in {fresh}place {touch.standing}: spread {length_said(touch.spread_mm)}"
    if happened.scatter_mm is not None:
        said += f", scatter in its seat {length_said(happened.scatter_mm)}"
    lines = [said + "."]
    if happened.moved:
        lines.append(f"It is {happened.apart_mm:.0f} mm from where it was: taken as moved, a new place.")
        if happened.against >= AGAIN:
            lines += ["If it stands still, the arm is known less well than PLAN says: end (q),", BEGIN_AGAIN]
    if happened.off_mm is not None and happened.times is not None and happened.times > SUSPICIOUS:
        lines.append(f"{happened.off_mm:.2f} mm off, {happened.times:.0f} times the scatter: ball not seated?")
        lines.append("Repeat it, and withdraw this one (w), or keep it.")
    return lines


def held_out_lines(places: int) -> list[str]:
    """What begins."""
    if not places:
        return ["Touches are fitted again: put it in another place."]
    return [f"Now {places} fresh places, not fitted, to judge by: where nothing was touched yet."]


def record_of(event: Event | Meter) -> dict[str, Any]:
    """As JSON has it."""
    match event:
        case Fault():
            return {"fault": event.as_dict()}
        case Refused():
            return {"refused": event.reason}
        case Happened():
            judged = {"scatter_mm": event.scatter_mm, "off_mm": event.off_mm, "times": event.times}
            return {"touch": as_dict(event.touch) | {"moved": event.moved, "apart_mm": event.apart_mm} | judged}
        case Meter():
            return {"known": _known(event)}
    raise AssertionError(event)


def _known(meter: Meter) -> dict[str, Any]:
    suggestion = meter.next
    so_far = meter.so_far
    return {
        "touches": so_far.touches,
        "determined": so_far.determined,
        "determinable": meter.determinable,
        "not_determined": so_far.not_determined,
        "lacking": meter.lacking.as_dict(),
        **asdict(meter.worth),
        "goal_u_mm": meter.goal_u_mm,
        "touches_more": meter.touches_more,
        "held_out": None if meter.fresh is None else asdict(meter.fresh),
        "next": {
            "feature": suggestion.name,
            "here": suggestion.here,
            "point_mm": suggestion.point_mm.tolist(),
            "places_mm": suggestion.stand.points_mm.tolist(),
            "q_rad": suggestion.q_rad.tolist(),
            "elbow": suggestion.elbow,
            "from": suggestion.comes_from,
            "gain": suggestion.gain,
        },
    }


def length_said(mm: float) -> str:
    """Three digits of a small length, in the unit in which people say it."""
    if not math.isfinite(mm):
        return "–"
    if mm >= 1.0:
        return f"{mm:.1f} mm"
    return f"{1000.0 * mm:.0f} µm" if mm >= 0.01 else f"{1000.0 * mm:.1f} µm"
