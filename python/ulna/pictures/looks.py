"""How each part of a picture looks: names of colours, and the colours of a light and a dark page.

x, y and z are red, green and blue in the tones of Okabe and Ito (2008), which colour-blind readers can tell apart, and
every arrow has its letter besides.
"""

from __future__ import annotations

from dataclasses import dataclass

LIGHT = {
    "paper": "#ffffff", "ink": "#1b1f24", "soft": "#505a66", "grid": "#dde2e8", "grid-axis": "#aab3bd",
    "link": "#c3ccd6", "joint": "#8796a7", "cap": "#a3b0be", "edge": "#45505c", "probe": "#d9dee4",
    "x": "#c8401c", "y": "#00855f", "z": "#0065b3", "tip": "#b8387f", "size": "#8a5a00", "lit": "#f0b429",
}  # fmt: skip
DARK = {
    "paper": "#14171b", "ink": "#e7eaee", "soft": "#aab3bd", "grid": "#2b323a", "grid-axis": "#4c5762",
    "link": "#56626f", "joint": "#75859a", "cap": "#93a3b8", "edge": "#0c0e11", "probe": "#8b97a5",
    "x": "#ff7a52", "y": "#3ccf9e", "z": "#63b5ff", "tip": "#ff8cc6", "size": "#ffc24d", "lit": "#8a6a1c",
}  # fmt: skip


@dataclass(frozen=True)
class Look:
    """Of the marks of one role. Widths in px."""

    fill: str | None = None
    """A colour's name; None: none."""
    stroke: str | None = None
    width: float = 0.0
    dash: tuple[float, ...] = ()
    size: float = 0.0
    """Of letters."""
    bold: bool = False


def _letters(colour: str, size: float = 12.0, bold: bool = False) -> Look:
    return Look(fill=colour, size=size, bold=bold)


#: role → look
LOOKS: dict[str, Look] = {
    "grid": Look(stroke="grid", width=1.0),
    "grid-axis": Look(stroke="grid-axis", width=1.2),
    "grid-name": _letters("soft", 11.0),
    "foot": Look(fill="joint", stroke="edge", width=1.0),
    "joint": Look(fill="joint", stroke="edge", width=1.0),
    "cap": Look(fill="cap", stroke="edge", width=0.8),
    "mark": Look(fill="edge"),
    "link": Look(fill="link", stroke="edge", width=1.0),
    "probe": Look(fill="probe", stroke="edge", width=0.8),
    "tip": Look(fill="tip", stroke="paper", width=1.0),
    "tip-name": _letters("tip", 12.0, bold=True),
    "axis": Look(stroke="soft", width=1.2, dash=(9.0, 3.0, 2.0, 3.0)),
    "axis-name": _letters("ink", 13.0, bold=True),
    "sense": Look(stroke="ink", width=1.4),
    "sense-head": Look(fill="ink"),
    **{each: Look(stroke=each, width=2.2) for each in "xyz"},
    **{f"{each}-head": Look(fill=each) for each in "xyz"},
    **{f"{each}-name": _letters(each) for each in "xyz"},
    "length": Look(stroke="size", width=3.0),
    "length-name": _letters("size", 13.0, bold=True),
    "angle": Look(stroke="size", width=2.0),
    "angle-name": _letters("size", 13.0, bold=True),
    "reference": Look(stroke="size", width=1.0, dash=(3.0, 3.0)),
    "artefact": Look(fill="z", stroke="paper", width=0.6),
    "artefact-end": Look(fill="z", stroke="paper", width=0.6),
    "artefact-name": _letters("ink", 16.0, bold=True),
    "scale": Look(stroke="soft", width=1.6),
    "scale-name": _letters("soft", 11.0),
}


def css() -> str:
    """Rules for classes of the same names as the roles; colours are variables: `--arm-x`."""
    rules = []
    for role, look in LOOKS.items():
        said = [f"fill: {'none' if look.fill is None else f'var(--arm-{look.fill})'}"]
        if look.stroke is not None:
            said.append(f"stroke: var(--arm-{look.stroke}); stroke-width: {look.width:g}px")
        if look.dash:
            said.append(f"stroke-dasharray: {' '.join(f'{each:g}' for each in look.dash)}")
        if look.size:
            weight = 700 if look.bold else 500
            said.append(f"font-size: {look.size:g}px; font-weight: {weight}")
        rules.append(f".arm .{role} {{ {'; '.join(said)} }}")
    return "\n".join(rules) + "\n"


def variables(colours: dict[str, str]) -> str:
    """The colours as variables of CSS."""
    return " ".join(f"--arm-{name}: {value};" for name, value in colours.items())
