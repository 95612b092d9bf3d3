"""Whether residuals still follow the turn of a joint."""

from __future__ import annotations

from rich.console import RenderableType
from rich.text import Text

from ulna.calibration.residual_map import ResidualMap
from ulna.cli.printed.tables import table
from ulna.ground.digits import fixed


def mapped(found: ResidualMap | None, all_of_it: bool) -> list[RenderableType]:
    """Nothing where nobody asked; a sentence, with all of it a row for each joint."""
    if found is None:
        return []
    if not found.joints:
        return ["", Text("Residuals were not mapped: too few touches to leave some out.")]
    parts: list[RenderableType] = [""]
    if all_of_it:
        heads = ("joint", "share / %", "± u", "amplitude / rad", "")
        rows = [
            (
                str(each.joint),
                fixed(100.0 * each.share, 1),
                fixed(100.0 * each.u_share, 1),
                f"{each.amplitude_rad:.1e}",
                "follows" if each.follows else "",
            )
            for each in found.joints
        ]
        title = f"What a map over a joint's angle predicts of residuals left out ({found.groups} {found.by})"
        parts.append(table(title, heads, rows))
    return [*parts, Text(said(found))]


def said(found: ResidualMap) -> str:
    """In a sentence."""
    if not found.missing:
        return "No joint's turn predicts residuals left out: nothing that follows a single joint is missing."
    share = {each.joint: each.share for each in found.joints}
    joints = [f"joint {joint} ({fixed(100.0 * share[joint], 0)} % of their squares)" for joint in found.missing]
    return f"Residuals left out still follow the turn of {', '.join(joints)}: a block is missing."
