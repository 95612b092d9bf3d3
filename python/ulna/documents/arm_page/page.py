"""The page of an arm: a picture with a slider for each joint. `map.js` turns them; all else comes from here."""

from __future__ import annotations

import math
from dataclasses import dataclass
from importlib import resources
from typing import Any

import numpy as np
from markupsafe import Markup

from ulna.arm.arm import Arm
from ulna.arm.frames.bodies import constant_transforms, pictured, turns
from ulna.arm.joint import Joint
from ulna.documents.html.arm_plot import rules
from ulna.documents.html.blocks import asset as report_asset
from ulna.documents.html.blocks import environment
from ulna.documents.html.markup import digest, json_in_script
from ulna.documents.languages.text import Text, joined, plain
from ulna.documents.languages.words import Words
from ulna.ground.arrays import F64
from ulna.ground.digits import fixed
from ulna.ground.version import VERSION
from ulna.pictures.scene import Scene
from ulna.pictures.svg import picture
from ulna.pictures.view import AZIMUTH_RAD, ELEVATION_RAD, around

#: nothing is fetched or sent, and only the scripts of this file run, known by their SHA-256
POLICY = (
    "default-src 'none'; script-src {scripts}; style-src 'unsafe-inline'; img-src data:; connect-src 'none'; "
    "base-uri 'none'; form-action 'none'"
)
SCRIPTS = ("map.js", "picture.js", "controls.js")
STEP_DEG = 0.1
"""Of a slider."""
SHOWN = ("axes", "frames", "dimensions", "floor")
"""What the reader may leave out, in the order of the boxes."""
FIRST = ("axes", "frames", "floor")
"""What is there before anybody has chosen."""
#: name → azimuth and elevation of the eye, degrees
VIEWS = {"oblique": (math.degrees(AZIMUTH_RAD), math.degrees(ELEVATION_RAD)), "x": (0, 0), "y": (90, 0), "z": (-90, 90)}
SIZE_PX = (760.0, 560.0)
"""Of the picture that stands there without scripts."""


@dataclass(frozen=True)
class Row:
    """A joint on the page, angles in degrees, as texts where they are only shown."""

    number: int
    name: str
    low: str
    high: str
    """Of the slider."""
    limits: str
    theta0: str
    alpha: str
    a: str
    d: str
    beta: str
    sign: str


def render(scene: Scene, start_rad: F64, language: str = "en") -> str:
    """The page as text, to be written as UTF-8. The same arm gives the same text. start_rad: (n,) the pose in which it
    opens."""
    words, arm = Words(language), scene.arm
    scripts = [_asset(name) for name in SCRIPTS]
    say: Any = words
    title = plain(words("show.picture", arm=arm.name))
    still = picture(scene, start_rad, around(scene, start_rad, *SIZE_PX), title, FIRST)
    page = environment().from_string(_asset("page.html.jinja"))
    tip_mm = scene.tip_mm(start_rad)
    return page.render(
        words=words,
        arm=arm,
        probe=scene.probe,
        version=VERSION,
        policy=POLICY.format(scripts=" ".join(f"'sha256-{digest(script)}'" for script in scripts)),
        style=Markup(report_asset("style.css") + rules() + _asset("style.css")),
        picture=still,
        views=[
            (f"{azimuth:.6g} {elevation:.6g}", words(f"show.view-{name}"))
            for name, (azimuth, elevation) in VIEWS.items()
        ],
        boxes=[(each, words(f"show.box-{each}"), each in FIRST) for each in SHOWN],
        rows=[_row(k, joint, arm) for k, joint in enumerate(arm.joints, start=1)],
        hayati=any(joint.model == "hayati" for joint in arm.joints),
        tip=dict(zip("xyz", (fixed(value, 3) for value in tip_mm.tolist()), strict=True)),
        reach=(f"{scene.reach_mm:.0f}",),
        step=(f"{scene.step_mm:g}",),
        notes=_notes(arm, say),
        data=Markup(json_in_script(_data(scene, start_rad))),
        scripts=[Markup(script) for script in scripts],
    )


def _row(number: int, joint: Joint, arm: Arm) -> Row:
    low, high = _limits_deg(joint)
    linked = number < arm.n or arm.full_last_link
    length = {"a": joint.a_mm, "d": joint.d_mm} if joint.model == "dh" else {"a": joint.a_mm}
    angle = {"theta0": joint.theta0_rad, "alpha": joint.alpha_rad}
    angle |= {} if joint.model == "dh" else {"beta": joint.beta_rad}
    shown = {name: fixed(value, 3) for name, value in length.items()}
    shown |= {name: fixed(math.degrees(value), 4) for name, value in angle.items()}
    none = dict.fromkeys(("theta0", "alpha", "a", "d", "beta"), "–")
    return Row(
        number=number,
        name=joint.name or "",
        low=f"{math.ceil(low / STEP_DEG - 1e-6) * STEP_DEG:.1f}",
        high=f"{math.floor(high / STEP_DEG + 1e-6) * STEP_DEG:.1f}",
        limits="∞" if joint.endless else f"{low:.5g} … {high:.5g}" if joint.limits_rad else "–",
        sign={1: "+1", -1: "−1"}.get(joint.sign, "?"),
        **{**none, **(shown if linked else {})},
    )


def _limits_deg(joint: Joint) -> tuple[float, float]:
    """Of its travel; half a turn either way of an endless one, and where nobody said."""
    low, high = joint.travel_rad or (-math.pi, math.pi)
    return math.degrees(low), math.degrees(high)


def _notes(arm: Arm, words: Words) -> list[Text]:
    """What the picture cannot show of this arm."""
    found = []
    unseen = [effect for effect in arm.effects if not pictured(effect, arm)]
    if unseen:
        extras = joined([words(f"extra.{effect.name}") for effect in unseen], ", ")
        found.append(words("show.left-out", extras=extras))
    unknown = [str(k) for k, joint in enumerate(arm.joints, start=1) if joint.sign == 0]
    if unknown:
        found.append(words("show.sign-unknown", joints=(", ".join(unknown),)))
    return found


def _data(scene: Scene, start_rad: F64) -> dict[str, Any]:
    """What the scripts need. Transforms and the tip have all their digits, shapes are to 1 µm."""
    arm = scene.arm
    return {
        "before": [t[:3].ravel().tolist() for t in constant_transforms(arm)],
        "turns": turns(arm).tolist(),
        "tip": arm.probes[scene.probe].tip_mm.tolist(),
        "start": np.degrees(start_rad).round(10).tolist(),
        "limits": [_limits_deg(joint) for joint in arm.joints],
        "limited": [joint.limits_rad is not None for joint in arm.joints],
        "view": [AZIMUTH_RAD, ELEVATION_RAD],
        "shapes": [
            [s.kind, s.body, s.group, s.role, s.points_mm.round(3).ravel().tolist(), s.joint, s.text, s.radius_mm]
            for s in scene.shapes
        ],
    }


def _asset(file: str) -> str:
    return (resources.files("ulna.documents.arm_page") / file).read_text(encoding="utf-8").replace("\r\n", "\n")
