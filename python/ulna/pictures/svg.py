"""Marks as SVG: within a page that has the looks, or a file of its own that follows the reader's light or dark."""

from __future__ import annotations

import numpy as np
from markupsafe import Markup, escape

from ulna.ground.arrays import F64
from ulna.pictures.looks import DARK, LIGHT, css, variables
from ulna.pictures.scene import Scene, round_step
from ulna.pictures.view import NAME_PX, Mark, Marks, View, marks

HALO = "paint-order: stroke; stroke: var(--arm-paper); stroke-width: 3px; stroke-linejoin: round"
"""About letters, so that they are read on lines."""


def picture(
    scene: Scene, q_rad: F64, view: View, title: str, groups: tuple[str, ...], lit: tuple[int, ...] = ()
) -> Markup:
    """An `<svg>` for a page whose style has `css()` and the colours. title: what a screen reader says. groups: what is
    shown beside the arm. lit: joints of which the dimensions are shown."""
    shown = [each for each in marks(scene, q_rad, view) if _shown(each, groups, lit)]
    inner = Markup("\n").join([*map(_mark, shown), *map(_mark, scale_bar(view))])
    return Markup(
        '<svg class="arm" role="img" aria-label="{}" viewBox="0 0 {} {}" xmlns="http://www.w3.org/2000/svg">\n{}\n</svg>'
    ).format(title, _px(view.width_px), _px(view.height_px), inner)


def standalone(inner: Markup) -> str:
    """A picture as a file: with its looks, its colours, and paper behind it."""
    style = (
        f".arm {{ {variables(LIGHT)} font-family: system-ui, sans-serif; background: var(--arm-paper) }}\n"
        f"@media (prefers-color-scheme: dark) {{ .arm {{ {variables(DARK)} }} }}\n"
        f".arm text {{ {HALO} }}\n.arm path {{ stroke-linejoin: round; stroke-linecap: round }}\n{css()}"
    )
    head, rest = str(inner).split("\n", 1)
    return f"{head}\n<style>\n{style}</style>\n{rest}\n"


def scale_bar(view: View) -> Marks:
    """A length in the corner, round and about a fifth of the width."""
    length_mm = round_step(0.2 * view.width_px / view.px_per_mm)
    x, y = 14.0, view.height_px - 14.0
    end = x + length_mm * view.px_per_mm
    corners = np.array([[x, y - 5.0], [x, y], [end, y], [end, y - 5.0]])
    middle = np.array([[(x + end) / 2.0, y - 4.0]])
    return [
        Mark("line", "floor", "scale", 0, corners),
        Mark("word", "floor", "scale-name", 0, middle, text=f"{length_mm:g} mm"),
    ]


def _shown(mark: Mark, groups: tuple[str, ...], lit: tuple[int, ...]) -> bool:
    if mark.group == "dimensions":
        return mark.joint in lit
    return mark.group == "arm" or mark.group in groups


def _mark(mark: Mark) -> Markup:
    kind = escape(mark.role)
    (x, y), *_ = mark.points_px.tolist()
    if mark.form == "word":
        return Markup('<text class="{}" x="{}" y="{}" text-anchor="middle">{}</text>').format(
            kind, _px(x), _px(y - NAME_PX), mark.text
        )
    if mark.form == "circle":
        return Markup('<circle class="{}" cx="{}" cy="{}" r="{}"/>').format(kind, _px(x), _px(y), _px(mark.radius_px))
    points = "L".join(f"{_px(x)} {_px(y)}" for x, y in mark.points_px.tolist())
    return Markup('<path class="{}" d="M{}{}"/>').format(kind, points, "Z" if mark.form == "area" else "")


def _px(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")
