"""The arm of a report as a picture, in the colours of the reader's theme."""

from __future__ import annotations

from ulna.documents.content.standing import StandingArm
from ulna.documents.html.plots import Still
from ulna.documents.languages.text import plain
from ulna.documents.languages.words import Words
from ulna.pictures.looks import DARK, LIGHT, css, variables
from ulna.pictures.svg import picture
from ulna.pictures.view import AZIMUTH_RAD, ELEVATION_RAD, fitted

WIDTH_PX, MOST_PX = 860.0, 600.0
GROUPS = ("axes", "frames", "floor")


def arm_plot(name: str, found: StandingArm, words: Words) -> Still:
    """Seen obliquely, with axes, frames and the floor."""
    view = fitted(found.scene, found.q_rad, WIDTH_PX, MOST_PX, AZIMUTH_RAD, ELEVATION_RAD)
    title = plain(words("show.picture", arm=found.scene.arm.name))
    return Still(name, picture(found.scene, found.q_rad, view, title, GROUPS))


def rules() -> str:
    """CSS of such pictures: their looks, and their colours by the reader's light or dark; on paper light."""
    light, dark = variables(LIGHT), variables(DARK)
    return (
        f":root {{ {light} }}\n"
        f'@media (prefers-color-scheme: dark) {{ :root:not([data-theme="light"]) {{ {dark} }} }}\n'
        f':root[data-theme="dark"] {{ {dark} }}\n'
        f'@media print {{ :root, :root[data-theme="dark"], :root:not([data-theme="light"]) {{ {light} }} }}\n'
        "svg.arm { display: block; width: 100%; height: auto; overflow: hidden }\n"
        ".arm path { stroke-linejoin: round; stroke-linecap: round }\n"
        ".arm text { paint-order: stroke; stroke: var(--arm-paper); stroke-width: 3px; stroke-linejoin: round }\n"
        f"{css()}"
    )
