"""Seen from somewhere: a right-handed parallel projection, hulls, what faces the reader, and SVG that is safe."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from tests.pictures.arms import random_arm
from tests.reports import HOSTILE

from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.pictures.looks import DARK, LIGHT, LOOKS
from ulna.pictures.scene import scene
from ulna.pictures.svg import picture, scale_bar, standalone
from ulna.pictures.view import View, around, fitted, hull, marks

ALL = ("axes", "frames", "floor")


def view_of(azimuth: float, elevation: float) -> View:
    return View(azimuth, elevation, np.array([10.0, -20.0, 30.0]), 0.5, 400.0, 300.0)


def test_the_projection_keeps_lengths_across_and_hands() -> None:
    rng = np.random.default_rng(0)
    for azimuth, elevation in rng.uniform(-1.5, 1.5, (50, 2)):
        axes = view_of(azimuth, elevation).axes()
        assert np.allclose(axes @ axes.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(axes) == pytest.approx(1.0)


def test_up_is_up_and_right_is_right() -> None:
    view = view_of(-math.pi / 2.0, 0.0)  # from -y: x runs to the right, z up
    seen = view.seen(
        view.centre_mm + np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [0.0, 0.0, 100.0], [0.0, -9.0, 0.0]])
    )
    assert np.allclose(seen, [[200, 150, 0], [250, 150, 0], [200, 100, 0], [200, 150, 9]])


def test_the_hull_is_that_of_another_program() -> None:
    rng = np.random.default_rng(3)
    for count in (3, 5, 40, 200):
        points = rng.normal(0.0, 50.0, (count, 2))
        found = hull(points)
        expected = points[ConvexHull(points).vertices]
        assert {tuple(p) for p in found.tolist()} == {tuple(p) for p in expected.tolist()}


def test_of_two_ends_of_a_joint_one_is_seen() -> None:
    arm = random_arm(1, 6)
    drawn = scene(arm)
    rng = np.random.default_rng(2)
    for azimuth, elevation in rng.uniform(-1.4, 1.4, (10, 2)):
        seen = marks(drawn, rng.uniform(-3, 3, arm.n), fitted(drawn, np.zeros(arm.n), 600, 500, azimuth, elevation))
        caps = [mark.joint for mark in seen if mark.role == "cap"]
        assert sorted(caps) == list(range(1, arm.n + 1))


def test_what_is_nearer_is_painted_later() -> None:
    """Two arms' worth of joints, one behind the other along the line of sight."""
    arm = Arm("row", (Joint(0.0, 0.0, 300.0, 0.0), Joint(0.0, 0.0, 300.0, 0.0), Joint()), {"tip": Probe(0.0, 0.0, 9.0)})
    drawn = scene(arm)
    for azimuth, expected in ((0.0, [1, 2, 3]), (math.pi, [3, 2, 1])):  # links run along x
        seen = marks(drawn, np.zeros(3), View(azimuth, 0.2, np.zeros(3), 1.0, 600.0, 400.0))
        assert [mark.joint for mark in seen if mark.role == "joint"] == expected


@pytest.mark.parametrize("seed", range(6))
def test_a_fitted_view_holds_the_whole_arm(seed: int) -> None:
    arm = random_arm(seed, 3 + seed % 5)
    drawn = scene(arm)
    q_rad = np.random.default_rng(seed).uniform(-3, 3, arm.n)
    view = fitted(drawn, q_rad, 700.0, 500.0, 0.3 * seed, 0.4)
    assert view.height_px <= 500.0 + 1e-9
    own = [mark for mark in marks(drawn, q_rad, view) if mark.group != "floor" and mark.group != "dimensions"]
    points = np.concatenate([mark.points_px for mark in own])
    assert (points >= 0.0).all()
    assert (points <= [view.width_px, view.height_px]).all()


def test_the_scale_is_as_long_as_it_says() -> None:
    view = view_of(0.0, 0.0)
    line, word = scale_bar(view)
    length_px = float(np.ptp(line.points_px[:, 0]))
    assert word.text.endswith(" mm")
    assert length_px / view.px_per_mm == pytest.approx(float(word.text.removesuffix(" mm")))


def test_every_role_has_its_look_and_every_colour_both_themes() -> None:
    assert set(LIGHT) == set(DARK)
    used = {colour for look in LOOKS.values() for colour in (look.fill, look.stroke) if colour}
    assert used <= set(LIGHT)
    roles = {shape.role for shape in scene(random_arm(0, 7, full=True)).shapes}
    assert roles <= set(LOOKS)


def luminance(colour: str) -> float:
    """Relative luminance after WCAG 2."""
    channels = [int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return float(np.dot(linear, [0.2126, 0.7152, 0.0722]))


@pytest.mark.parametrize("colours", [LIGHT, DARK], ids=["light", "dark"])
def test_letters_can_be_read(colours: dict[str, str]) -> None:
    paper = luminance(colours["paper"])
    for role, look in LOOKS.items():
        if look.size and look.fill is not None:
            low, high = sorted((paper, luminance(colours[look.fill])))
            assert (high + 0.05) / (low + 0.05) >= 4.5, role


def test_names_are_text_and_the_svg_is_whole() -> None:
    joints = tuple(Joint(0.2, 1.3, 50.0, 90.0, name=name) for name in HOSTILE[:4])
    arm = Arm(HOSTILE[1], (*joints, Joint()), {HOSTILE[0]: Probe(1.0, 2.0, 40.0)})
    drawn = scene(arm)
    q_rad = np.zeros(arm.n)
    text = standalone(picture(drawn, q_rad, around(drawn, q_rad, 500, 400), HOSTILE[1], ALL, lit=(1,)))
    root = ET.fromstring(text)
    assert {element.tag.split("}")[1] for element in root.iter()} == {"svg", "style", "path", "circle", "text"}
    assert root.attrib["aria-label"] == HOSTILE[1]
    assert "<script" not in text
    assert not re.search(r"nan|inf\b", re.sub(r"<style>.*?</style>", "", text, flags=re.S))


def test_the_same_arm_gives_the_same_picture() -> None:
    arm = random_arm(4, 6)
    drawn = scene(arm)
    q_rad = np.full(arm.n, 0.3)
    view = around(drawn, q_rad, 500, 400)
    assert picture(drawn, q_rad, view, "x", ALL) == picture(scene(arm), q_rad, view, "x", ALL)


def test_groups_are_left_out_and_dimensions_shown_where_asked() -> None:
    arm = random_arm(4, 6)
    drawn = scene(arm)
    q_rad = np.zeros(arm.n)
    view = around(drawn, q_rad, 500, 400)
    bare = picture(drawn, q_rad, view, "x", ())
    assert 'class="axis"' not in bare
    assert 'class="x"' not in bare
    assert 'class="grid"' not in bare
    assert 'class="angle"' not in bare
    assert 'class="joint"' in bare
    lit = picture(drawn, q_rad, view, "x", (), lit=(1,))
    assert len(re.findall('class="angle"', lit)) == 2
