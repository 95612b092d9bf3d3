"""The arm in reports: the pose of a reading in the middle, the same marks on page and paper, any names."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest
from tests.cli_runs import platinum, write_lengths
from tests.reports import HOSTILE, calibrated, seats_study

from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.documents.content.content import Content
from ulna.documents.content.standing import StandingArm
from ulna.documents.drawn import arm as drawn_arm
from ulna.documents.gather import gather
from ulna.documents.html.arm_plot import arm_plot, rules
from ulna.documents.html.page import render
from ulna.documents.languages.said import Said
from ulna.documents.languages.words import Words
from ulna.documents.pdf import arm_plot as on_paper
from ulna.documents.pdf.canvas import looks
from ulna.pictures.scene import scene
from ulna.study.study import Study


@pytest.fixture(scope="module")
def seats(tmp_path_factory: pytest.TempPathFactory) -> tuple[Content, Study]:
    study = seats_study(tmp_path_factory.mktemp("seats"))
    return gather(calibrated(study)), Study.load(study)


def standing(arm: Arm) -> StandingArm:
    return StandingArm(scene(arm), np.full(arm.n, 0.3), Said("plot.arm-start", {"probe": "x", "step": "100"}))


def test_it_stands_as_one_of_the_readings_did_and_the_caption_says_which(seats: tuple[Content, Study]) -> None:
    content, study = seats
    found = content.standing
    (group,) = study.readings
    (k,) = np.flatnonzero((group.q_rad == found.q_rad).all(axis=1)).tolist()
    assert found.said.values["row"] == int(group.row[k])
    assert found.said.values["file"] == "touches.csv"
    page = re.sub("<[^>]+>", "", render(content))
    assert f"row {int(group.row[k])} of touches.csv" in page
    middle = np.median(group.q_rad, axis=0)
    off = np.linalg.norm(group.q_rad - middle, axis=1)
    assert off[k] < np.median(off)


def test_where_the_study_is_not_known_it_says_so(tmp_path) -> None:
    result = calibrated(write_lengths(tmp_path))
    (tmp_path / "study.toml").unlink()
    content = gather(result)
    assert content.standing.said.key == "plot.arm-start"
    assert content.standing.q_rad.tolist() == [0.0] * 7
    assert "in which poses it was read is not known" in render(content)


def test_page_and_paper_have_the_same_marks() -> None:
    """All that is drawn in lines and areas; letters on paper are drawn as paths of their own."""
    found = standing(platinum())
    page = str(arm_plot("arm", found, Words("en")).place)
    with looks([]):
        paper = on_paper.arm(found)
    seen = len(re.findall("<(?:path|circle)", page))
    lines = len(re.findall(r'<g id="line2d_\d+">', paper))
    areas = len(re.findall(r'<g id="patch_\d+">', paper)) - 1  # the figure's own paper
    assert lines + areas == seen > 100
    with looks([]):
        assert on_paper.arm(found) == paper, "the same arm gives the same bytes"


def test_names_that_no_font_has_do_not_stop_the_paper() -> None:
    joints = tuple(Joint(0.2, 1.3, 50.0, 90.0, name=name) for name in (*HOSTILE[:4], "関節", "$x_2"))
    arm = Arm(HOSTILE[3], (*joints, Joint()), {"测头": Probe(1.0, 2.0, 40.0)})
    with looks([]), warnings.catch_warnings():
        warnings.simplefilter("error")
        assert on_paper.arm(standing(arm)).startswith("<?xml")


@pytest.mark.parametrize(
    ("name", "drawn"), [("3 elbow", "3 elbow"), ("3 関節", "3"), ("12", "12"), ("测头", ""), ("bent", "bent")]
)
def test_of_a_name_that_cannot_be_drawn_its_number_stays(name: str, drawn: str) -> None:
    assert drawn_arm._plain(name) == drawn


def test_the_picture_follows_the_theme_and_prints_light() -> None:
    text = rules()
    dark, printed = text.index("prefers-color-scheme: dark"), text.index("@media print")
    assert "#14171b" in text[dark:printed]
    assert "#14171b" not in text[printed:]
    assert "#ffffff" in text[printed:]
