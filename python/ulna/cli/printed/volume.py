"""A volume map, for the terminal."""

from __future__ import annotations

from rich.console import RenderableType
from rich.text import Text

from ulna.cli.printed.tables import heading, listed, table
from ulna.ground.digits import uncertainty
from ulna.uncertainties.assess import depends_on
from ulna.uncertainties.volume import VolumeMap
from ulna.uncertainties.zones import Spread, by_distance, by_length


def volume_report(found: VolumeMap) -> list[RenderableType]:
    """Points by distance from the base, lengths by length, what is open, what is left out."""
    points, lengths = by_distance(found), by_length(found)
    open_too = any(spread.not_determined for _, _, spread in points) or any(u.not_determined for _, u, _ in lengths)
    heads = ("places", *(("not determined",) if open_too else ()), "median", "95 % have less", "largest")
    percent = f"{100 * found.p:g} %"
    parts: list[RenderableType] = [
        Text(f"Arm {found.arm}, probe {found.probe}, all over its volume (reach {found.reach_mm:.0f} mm)."),
        "",
        table(
            "A point's position, u = √(u_x² + u_y² + u_z²) / mm",
            ("from the base / mm", *heads),
            [(f"{low:.0f} to {high:.0f}", *_cells(spread, open_too)) for low, high, spread in points],
        ),
        "",
        table(
            f"A length, one touch at each end, U / mm (p = {percent})",
            ("length / mm", *heads),
            [(f"{length:g}", *_cells(expanded, open_too)) for length, _, expanded in lengths],
        ),
    ]
    if found.not_determined:
        parts += ["", heading("Not determined"), listed((depends_on("Some of it", d),) for d in found.not_determined)]
    parts += ["", heading("Left out"), listed((text,) for text in found.left_out)]
    return parts


def _cells(spread: Spread, open_too: bool) -> tuple[str, ...]:
    share = (f"{100 * spread.not_determined / spread.places:.0f} %",) if open_too else ()
    return (
        str(spread.places),
        *share,
        *(uncertainty(v) for v in (spread.median_mm, spread.most_mm, spread.largest_mm)),
    )
