"""The page of `ulna show`: safe with any names, self-contained, in every language, and right about every tip."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

import numpy as np
import pytest
from tests.browser import dom, node
from tests.pictures.arms import arms, coupled, random_arm
from tests.reports import HOSTILE

from ulna.arm.arm import Arm
from ulna.arm.effects.effects import Effects
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.documents.arm_page import page as arm_page
from ulna.documents.arm_page.page import SCRIPTS, render
from ulna.documents.html.markup import digest
from ulna.documents.languages.languages import LANGUAGES
from ulna.documents.languages.words import dictionary
from ulna.pictures.scene import Scene, scene
from ulna.pictures.view import AZIMUTH_RAD, ELEVATION_RAD, FILLED, Mark, View, marks

SMALL_BYTES = 20_000
SOURCES = Path(arm_page.__file__).parent
MAP = (SOURCES / "map.js").read_text(encoding="utf-8")


def data_of(page: str) -> dict:
    (found,) = re.findall(r'<script type="application/json" id="arm-data">(.*?)</script>', page, flags=re.S)
    return json.loads(found)


def opened(arm: Arm, language: str = "en") -> str:
    return render(scene(arm), np.zeros(arm.n), language)


# what the page says of an arm is the core's


@pytest.mark.parametrize("arm", arms(), ids=lambda arm: f"{arm.name}, {arm.n} joints, full {arm.full_last_link}")
def test_the_map_in_the_page_is_the_cores(arm: Arm, tmp_path: Path) -> None:
    """The page's own script and numbers, in an engine of JavaScript."""
    poses = np.random.default_rng(arm.n).uniform(-6.0, 6.0, (50, arm.n))
    for name in arm.probes:
        data = data_of(render(scene(arm, name), np.zeros(arm.n)))
        script = f"""{MAP}
        const data = {json.dumps(data)}, poses = {json.dumps(poses.tolist())};
        console.log(JSON.stringify(poses.map(q => {{
          const stand = ArmMap.bodies(data.before, data.turns, q);
          return ArmMap.at(stand[stand.length - 1], ...data.tip);
        }})));"""
        tips_mm = np.array(json.loads(node(script, tmp_path)))
        assert np.abs(tips_mm - arm.tip(poses, name)).max() < 1e-9


READ = """
const poses = POSES, found = [];
const entries = Array.from(document.querySelectorAll("li.joint input[type=number]"));
poses.forEach(pose => {
  pose.forEach((angle, k) => { entries[k].value = angle; entries[k].dispatchEvent(new Event("input")); });
  found.push(document.getElementById("tip").dataset.mm + " " + ["x", "y", "z"].map(
    axis => document.getElementById("tip-" + axis).textContent).join(" "));
});
document.title = JSON.stringify(found);
"""


@pytest.mark.parametrize("number", [2, 5, 8])
def test_the_tip_that_a_reader_sees_is_the_cores(number: int, tmp_path: Path) -> None:
    """In a browser, by the fields for angles, to the last digit that they take."""
    arm = arms()[number]
    degrees = np.random.default_rng(number).uniform(-180.0, 180.0, (30, arm.n)).round(6)
    shown = dom(opened(arm), tmp_path, READ.replace("POSES", json.dumps(degrees.tolist())))
    title = html.unescape(re.findall("<title>(.*?)</title>", shown, flags=re.S)[0])
    found = np.array([[float(each) for each in row.split()] for row in json.loads(title)])
    expected_mm = arm.tip(np.radians(degrees), next(iter(arm.probes)))
    assert np.abs(found[:, :3] - expected_mm).max() < 1e-9
    assert np.abs(found[:, 3:] - expected_mm).max() <= 0.0005 + 1e-9


def points(text: str) -> np.ndarray:
    return np.array([float(each) for each in re.findall(r"-?\d+(?:\.\d+)?", text)]).reshape(-1, 2)


def test_the_browser_draws_what_paper_shows(tmp_path: Path) -> None:
    """Mark by mark, to a tenth of a pixel; and nearer joints over farther ones."""
    arm = random_arm(11, 6)
    drawn = scene(arm)
    start_rad = np.random.default_rng(5).uniform(-2.0, 2.0, arm.n)
    shown = dom(render(drawn, start_rad), tmp_path)
    assert 'data-ready="yes"' in shown, "its own policy lets its scripts run"
    svg = shown[shown.index("<svg") : shown.index("</svg>")]
    width, height = (float(each) for each in re.findall(r'viewBox="0 0 (\S+) (\S+)"', svg)[0])
    middle, radius = drawn.extent(start_rad)
    view = View(AZIMUTH_RAD, ELEVATION_RAD, middle, FILLED * min(width, height) / radius, width, height)
    expected = marks(drawn, start_rad, view)
    found = [each for each in re.findall(r"<(?:path|circle|text) [^>]*>", svg) if "hidden" not in each]
    found = [each for each in found if "scale" not in each]
    assert len(found) == len(expected) > 100
    order = [re.findall('data-joint="([0-9]+)"', each)[0] for each in found if 'class="joint ' in each]
    assert order == [str(mark.joint) for mark in expected if mark.role == "joint"]
    for mark in expected:
        own = [each for each in found if f'class="{mark.role} in-{mark.group}"' in each and _same(each, mark)]
        assert own, mark
        found.remove(own[0])


def _same(element: str, mark: Mark) -> bool:
    attributes = dict(re.findall(r'([a-z]+)="([^"]*)"', element))
    if mark.form == "circle":
        seen = points(f"{attributes['cx']} {attributes['cy']}")
    elif mark.form == "word":
        seen = points(f"{attributes['x']} {float(attributes['y']) + 4.0}")
    else:
        seen = points(attributes["d"])
    return seen.shape == mark.points_px.shape and float(np.abs(seen - mark.points_px).max()) < 0.15


HOVER = """
window.requestAnimationFrame = work => setTimeout(work, 0);  // nothing is shown here, so no frame is ever due
document.querySelector('tr[data-joint="2"]').focus();
const shown = Array.from(document.querySelectorAll(".arm .in-dimensions")).filter(
  each => getComputedStyle(each).display !== "none");
const box = document.querySelector("[data-shown=frames]");
box.click();
const frames = Array.from(document.querySelectorAll(".arm .in-frames")).filter(
  each => getComputedStyle(each).display !== "none").length;
document.getElementById("mirror").click();
const mirrored = document.getElementById("pose").textContent;
document.getElementById("zero").click();
const zero = document.getElementById("pose").textContent;
document.getElementById("start").click();
const svg = document.querySelector("svg"), before = svg.querySelector(".foot").getAttribute("d");
svg.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
requestAnimationFrame(() => requestAnimationFrame(() => {
  document.title = JSON.stringify({
    joints: Array.from(new Set(shown.map(each => each.dataset.joint))), frames, mirrored, zero,
    start: document.getElementById("pose").textContent, focus: svg.tabIndex,
    turned: before !== svg.querySelector(".foot").getAttribute("d")
  });
}));
"""


def test_rows_boxes_buttons_and_keys_do_what_they_say(tmp_path: Path) -> None:
    arm = random_arm(3, 4)
    page = render(scene(arm), np.radians([10.0, -20.0, 30.5, 0.0]))
    title = html.unescape(re.findall("<title>(.*?)</title>", dom(page, tmp_path, HOVER), flags=re.S)[0])
    assert json.loads(title) == {
        "joints": ["2"],
        "frames": 0,
        "mirrored": "-10,20,-30.5,0",
        "zero": "0,0,0,0",
        "start": "10,-20,30.5,0",
        "focus": 0,
        "turned": True,
    }


# what the page is


@pytest.fixture(scope="module")
def hostile() -> Scene:
    joints = tuple(Joint(0.2, 1.3, 50.0, 90.0, name=name) for name in HOSTILE[:4])
    return scene(Arm(HOSTILE[1], (*joints, Joint()), {HOSTILE[0]: Probe(1.0, 2.0, 40.0)}))


@pytest.mark.parametrize("language", LANGUAGES)
def test_names_are_text_and_nothing_comes_from_elsewhere(hostile: Scene, language: str) -> None:
    page = render(hostile, np.zeros(5), language)
    assert page.count("<script") == 1 + len(SCRIPTS)
    assert "alert(1)</script>" not in page
    assert not re.search(r"<(img|iframe|link|object|form|base)\b", page)
    assert not re.search(r'\s(?:src|href)="', page)
    assert not re.search(r"url\(|@import|fetch\(|XMLHttp|WebSocket", page)
    assert re.findall(r"https?://[^\"' ]+", page) == ["http://www.w3.org/2000/svg"] * 2, "names of SVG, no addresses"
    assert f'<html lang="{dictionary(language)["language"]}">' in page
    assert dictionary(language)["show.compare"] in page
    if language != "en":
        assert dictionary("en")["show.compare"] not in page


def test_the_policy_knows_the_scripts_and_forbids_the_rest(hostile: Scene) -> None:
    page = render(hostile, np.zeros(5))
    scripts = re.findall(r"<script>(.*?)</script>", page, flags=re.S)
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', page)
    rules = {name: values for name, *values in (part.split() for part in html.unescape(policy).split(";"))}
    assert rules["script-src"] == [f"'sha256-{digest(script)}'" for script in scripts]
    assert rules["default-src"] == rules["connect-src"] == ["'none'"]


def test_scripts_are_small_and_the_same_arm_gives_the_same_bytes() -> None:
    assert sum(len((SOURCES / name).read_bytes()) for name in SCRIPTS) < SMALL_BYTES
    assert opened(random_arm(2, 7)) == opened(random_arm(2, 7))


def test_every_joint_has_its_slider_within_its_limits() -> None:
    joints = (
        Joint(0.1, 1.5, 10.0, 90.0, limits_rad=np.radians([-170.04, 100.08]).tolist()),
        Joint(0.1, -1.5, 10.0, 90.0, endless=True, name="elbow"),
        Joint(sign=-1),
    )
    page = opened(Arm("limits", joints, {"tip": Probe(0.0, 0.0, 50.0)}))
    sliders = re.findall(r'type="range" id="slider-(\d)" min="(\S+)" max="(\S+)"', page)
    assert sliders == [("1", "-170.0", "100.0"), ("2", "-180.0", "180.0"), ("3", "-180.0", "180.0")]
    assert page.count('<input type="number"') == 3
    rows = re.findall(r'<tr data-joint="\d" tabindex="0">(.*?)</tr>', page)
    cells = [re.sub("<[^>]+>", " ", row).split() for row in rows]
    assert cells[0] == ["1", "5.7296", "85.9437", "10.000", "90.000", "+1", "-170.04", "…", "100.08"]
    assert cells[1][-2:] == ["+1", "∞"]
    assert cells[2] == ["3", "–", "–", "–", "–", "−1", "–"]


def test_what_is_not_in_the_picture_is_said() -> None:
    joints = (Joint(0.1, 1.5, 10.0, 90.0, sign=0), Joint(effects=Effects(backlash_rad=1e-3)))
    page = opened(Arm("more", joints, {"tip": Probe(0.0, 0.0, 50.0)}))
    assert "Not in the picture: backlash" in page
    assert "Nobody knows which way the encoders of these joints count: 1" in page
    assert page.count('class="missing"') == 3  # and the one for readers without scripts
    assert "Not in the picture" not in opened(coupled(random_arm(9, 6))), "ratios of joints are in it"


def test_without_scripts_the_picture_is_there() -> None:
    page = opened(random_arm(2, 6))
    still = page[page.index("<svg") : page.index("</svg>")]
    assert still.count('class="joint"') == 6
    assert "<noscript>" in page
