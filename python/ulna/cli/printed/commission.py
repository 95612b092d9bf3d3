"""What `ulna live commission` prints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from ulna.ground.errors import for_people
from ulna.ground.terminal import plain_table
from ulna.live.commission.findings import Findings, FoundJoint

_BAR = 24
"""Columns of a bar: a turn, and no more."""


def bars(channels: Sequence[tuple[str, float, float]]) -> RenderableType:
    """How far each channel moved in this step, the farthest in bold."""
    table = Table(box=None, pad_edge=False, show_header=False)
    for side in ("left", "right", "right", "left"):
        table.add_column(justify=side, no_wrap=True)
    most = max((degrees for _, _, degrees in channels), default=0.0)
    for name, newest, degrees in channels:
        long = min(round(_BAR * degrees / 360.0), _BAR)
        style = "bold" if degrees == most and most > 0.0 else ""
        table.add_row(for_people(name)[:16], f"{newest:.8g}", f"{degrees:.1f}°", "█" * long, style=style)
    return Group(table)


def _sign(joint: FoundJoint) -> str:
    return {1: "+1", -1: "−1", 0: "?"}[joint.sign]


def findings_report(findings: Findings) -> list[RenderableType]:
    """A line for each joint, and what must be known; what is to be pasted follows, as it is in its file."""
    table = plain_table("What was found")
    for name in ("joint", "channel"):
        table.add_column(name, no_wrap=True)
    for name in ("from", "to", "sign", "a turn", "step", "noise"):
        table.add_column(name, justify="right", no_wrap=True)
    for k, joint in enumerate(findings.joints):
        low, high = (math.degrees(each) for each in findings.limits_rad(k))
        turn = "360°" if joint.counts_per_turn is None else f"{joint.counts_per_turn:g}"
        step = "–" if joint.step is None else f"{math.degrees(findings.rad(k, joint.step)):.2g}°"
        ends = ("endless", "") if joint.endless else (f"{low:.1f}°", f"{high:.1f}°")
        noise_deg = math.degrees(findings.noise_rad(k))
        table.add_row(str(k + 1), for_people(joint.channel)[:16], *ends, _sign(joint), turn, step, f"{noise_deg:.2g}°")
    drifts = [abs(math.degrees(findings.rad(k, joint.drift))) for k, joint in enumerate(findings.joints)]
    drift = f"Drift while it was held: {max(drifts):.2g}° at the most, in {findings.holding.seconds:.0f} s."
    lines = [drift, *findings.remarks]
    return [
        Text(),
        table,
        Text(),
        *(Text(f"- {for_people(line)}") for line in lines),
        Text(),
        Text("To paste, also in noise.toml", style="bold"),
    ]


def document(findings: Findings, out: Path) -> dict[str, Any]:
    """The machine form: rad."""
    joints = [
        {
            "channel": joint.channel,
            "sign": joint.sign,
            "limits_rad": None if joint.endless else list(findings.limits_rad(k)),
            "endless": joint.endless,
            "counts_per_turn": joint.counts_per_turn,
            "counts_why": joint.counts_why,
            "wraps": joint.wraps,
            "step_rad": None if joint.step is None else findings.rad(k, joint.step),
            "noise_rad": findings.noise_rad(k),
            "touch_noise_rad": findings.touch_noise_rad(k),
            "drift_rad": findings.rad(k, joint.drift),
            "along": dict(joint.along),
        }
        for k, joint in enumerate(findings.joints)
    ]
    held = {"seconds": findings.holding.seconds, "readings": findings.holding.readings}
    return {"unit": findings.unit, "held": held, "joints": joints, "remarks": findings.remarks, "written": str(out)}
