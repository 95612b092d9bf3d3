"""What a session says, in sentences and as JSON: one line of what is known, what to do next, what happened."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from ulna.ground.errors import for_people
from ulna.ground.worded import listed, worded
from ulna.live.events import Event, Happened, Meter
from ulna.live.faults import Fault
from ulna.live.session import SUSPICIOUS
from ulna.live.touches import as_dict
from ulna.live.trigger import Refused

AGAIN = 2
"""So often in a row an artefact is not moved by whoever was asked to leave it."""
BEGIN_AGAIN = worded("raise known_angle in it (0.09 rad where zeros are by eye), and begin again.")
ELBOWS = {
    "up": worded("elbow up"),
    "up-right": worded("elbow up-right"),
    "right": worded("elbow right"),
    "down-right": worded("elbow down-right"),
    "down": worded("elbow down"),
    "down-left": worded("elbow down-left"),
    "left": worded("elbow left"),
    "up-left": worded("elbow up-left"),
}
"""How the arm is held."""
PROBES = {
    "above": worded("probe from above"),
    "below": worded("probe from below"),
    "left": worded("probe from left"),
    "right": worded("probe from right"),
    "near": worded("probe from near"),
    "far": worded("probe from far"),
}
"""From where the probe comes."""
LYING = {
    "level": worded("level"),
    "rising": worded("rising"),
    "falling": worded("falling"),
    "upright": worded("upright"),
    "hanging": worded("hanging"),
}
"""How an artefact lies."""


def meter_line(meter: Meter) -> str:
    """ "23 of 25 known · U(500 mm) 71 µm → goal 40 µm · about 18 touches more"."""
    known = min(meter.so_far.determined, meter.determinable)
    worth = meter.worth
    line = worded(
        "{known} of {all} known · U({length} mm) {u}",
        known=known,
        all=meter.determinable,
        length=f"{worth.length_mm:.0f}",
        u=length_said(2.0 * worth.u_mm),
    )
    if meter.fresh is not None:
        now, places = min(meter.fresh.done + 1, meter.fresh.places), meter.fresh.places
        return worded("{line} · fresh place {now} of {places}, not fitted", line=line, now=now, places=places)
    if meter.goal_u_mm is None:
        return line
    goal = length_said(2.0 * meter.goal_u_mm)
    if worth.u_mm <= meter.goal_u_mm:
        return worded("{line}: goal {goal} reached", line=line, goal=goal)
    if meter.touches_more is None:
        return worded("{line} → goal {goal}", line=line, goal=goal)
    return worded("{line} → goal {goal} · about {count} touches more", line=line, goal=goal, count=meter.touches_more)


def next_lines(meter: Meter) -> list[str]:
    """Where to touch next, as one says it to somebody."""
    suggestion = meter.next
    what = worded("touch {feature}", feature=for_people(suggestion.name)) if suggestion.name else worded("touch it")
    held = [ELBOWS[suggestion.elbow]] if suggestion.elbow else []
    how = listed([what, *held, PROBES[suggestion.comes_from]])
    if suggestion.here:
        return [worded("Next, where it stands: {how}", how=how)]
    x, y, z = suggestion.stand.points_mm.mean(axis=0)
    stand = suggestion.stand
    at = {"x": f"{x:.0f}", "y": f"{y:.0f}", "z": f"{z:.0f}"}
    told = worded("  {how}", how=how)
    if stand.lies == "nowhere":
        return [worded("Next, put it at x {x}, y {y}, z {z} mm:", **at), told]
    steep = f" {abs(stand.slope_deg):.0f}°" if stand.lies in ("rising", "falling") else ""
    towards = f"{stand.azimuth_deg:.0f}"
    put = worded(
        "Next, put it at x {x}, y {y}, z {z} mm, {lies}{steep}, towards {towards}°:",
        lies=LYING[stand.lies],
        steep=steep,
        towards=towards,
        **at,
    )
    return [put, told]


def meter_lines(meter: Meter) -> list[str]:
    """Both."""
    return [meter_line(meter), *next_lines(meter)]


def happened_lines(happened: Happened, names: list[str]) -> list[str]:
    """A touch that was taken, and what is odd about it."""
    touch = happened.touch
    feature = f", {for_people(names[touch.feature])}" if touch.feature < len(names) else ""
    at = {"place": touch.standing}
    where = worded("fresh place {place}", **at) if touch.held_out else worded("place {place}", **at)
    said = {"number": str(touch.number), "feature": feature, "where": where, "spread": length_said(touch.spread_mm)}
    if happened.scatter_mm is None:
        lines = [worded("Touch {number}{feature} in {where}: spread {spread}.", **said)]
    else:
        said["scatter"] = length_said(happened.scatter_mm)
        lines = [worded("Touch {number}{feature} in {where}: spread {spread}, scatter in its seat {scatter}.", **said)]
    if happened.moved:
        lines.append(
            worded("It is {apart} mm from where it was: taken as moved, a new place.", apart=f"{happened.apart_mm:.0f}")
        )
        if happened.against >= AGAIN:
            lines += [
                worded("If it stands still, the arm is known less well than PLAN says: end (q),"),
                BEGIN_AGAIN,
            ]
    if happened.off_mm is not None and happened.times is not None and happened.times > SUSPICIOUS:
        lines.append(
            worded(
                "{off} mm off, {times} times the scatter: ball not seated?",
                off=f"{happened.off_mm:.2f}",
                times=f"{happened.times:.0f}",
            )
        )
        lines.append(worded("Repeat it, and withdraw this one (w), or keep it."))
    return lines


def held_out_lines(places: int) -> list[str]:
    """What begins."""
    if not places:
        return [worded("Touches are fitted again: put it in another place.")]
    return [worded("Now {places} fresh places, not fitted, to judge by: where nothing was touched yet.", places=places)]


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
