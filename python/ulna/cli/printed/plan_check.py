"""What became of a plan, at a glance."""

from __future__ import annotations

from rich.console import RenderableType

from ulna.cli.printed.tables import table
from ulna.planning.checking import FAR_DEG, FAR_MM, NOTICED, Checked
from ulna.planning.stands import runs

MOST = 15
"""Rows of a table; --json has all."""


def check_report(found: Checked) -> list[RenderableType]:
    """Missing placements, touches far off, what the readings tell beside the promise."""
    done = found.planned - len(found.missing)
    rows = [
        ("placements measured", f"{done} of {found.planned}"),
        ("touches as planned or near", f"{found.touches - len(found.far)} of {found.touches}"),
        ("directions determined", f"{found.determined} of {found.to_determine}"),
        ("u(length) promised / µm, rms", f"{1000 * found.promised_u_length_mm:.2f}"),
        ("u(length) of these readings / µm", "–" if found.u_length_mm is None else f"{1000 * found.u_length_mm:.2f}"),
    ]
    parts: list[RenderableType] = [table("Beside the plan", ("", "measured"), rows)]
    if found.far:
        far = [
            (
                each.placement,
                each.feature,
                str(each.row),
                f"{each.off_mm:.0f}",
                f"{each.off_deg:.0f}",
                str(each.joint),
            )
            for each in found.far[:MOST]
        ]
        title = f"Far from the plan: over {FAR_MM:g} mm or {FAR_DEG:g}°{_more(len(found.far))}"
        parts += ["", table(title, ("placement", "feature", "row", "tip / mm", "angle / °", "joint"), far, left=2)]
    if found.worse:
        worse = [
            (each.name, each.unit, f"{each.promised:.2g}", _now(each.now), _times(each.now, each.promised))
            for each in found.worse[:MOST]
        ]
        title = f"Known worse than promised, over {NOTICED:g} times{_more(len(found.worse))}"
        parts += ["", table(title, ("parameter", "unit", "u promised", "u now", "times"), worse, left=2)]
    return [*parts, "", _words(found)]


def _words(found: Checked) -> str:
    said = []
    if found.missing:
        said.append(f"Missing, whole or in part: placements {runs(found.missing)}.")
    else:
        said.append("All placements of the plan were measured.")
    if found.other:
        said.append(f"Not in the plan: {', '.join(found.other[:10])}{_more(len(found.other), 10)}.")
    if found.u_length_mm is None:
        said.append("The readings leave open what the plan would have determined: measure what is missing.")
    elif found.u_length_mm <= 1.1 * found.promised_u_length_mm:
        said.append("The readings tell as much of lengths as the plan promised.")
    else:
        times = found.u_length_mm / found.promised_u_length_mm
        said.append(f"Lengths are known {times:.2f} times worse than the plan promised.")
    return " ".join(said)


def _more(count: int, most: int = MOST) -> str:
    return f", {most} of {count}" if count > most else ""


def _now(value: float | None) -> str:
    return "–" if value is None else f"{value:.2g}"


def _times(now: float | None, promised: float) -> str:
    return "–" if now is None else f"{now / promised:.2f}"
