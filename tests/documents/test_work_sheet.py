"""The work sheet of a plan: read back from the PDF by another program."""

from __future__ import annotations

import re

import numpy as np
import pytest
from tests.pdf_reading import Pdf, holds
from tests.planning.test_plan import BAR, PLANE, SEAT, limited, spec

import ulna
from ulna.documents.languages.languages import LANGUAGES
from ulna.documents.languages.words import dictionary
from ulna.documents.work_sheet.sheet import work_sheet
from ulna.planning.outcome import Plan


@pytest.fixture(scope="module")
def plan() -> Plan:
    return ulna.plan(limited(), spec(choose=40, placements=7))


@pytest.fixture(scope="module")
def sheet(plan: Plan) -> Pdf:
    return Pdf(work_sheet(plan))


def test_every_stand_has_a_row_with_its_place(plan: Plan, sheet: Pdf) -> None:
    text = "".join(sheet.texts).replace("\N{MINUS SIGN}", "-")
    for stand in plan.stands:
        for name, point in zip("AB", stand.points_mm, strict=True):
            x, y, z = (f"{value:.0f}" if round(value) else "0" for value in point)
            assert re.search(rf"{name}:\s*\W*{x}\s+{y}\s+{z}\b", text.replace("\u2068", "").replace("\u2069", "")), (
                name,
                point,
            )
        # one box for the row, and one for each touch
    touches = sum(len(each.measurements) for each in plan.stands) * 2
    assert text.count("☐") == touches + len(plan.stands)


def test_every_touch_has_its_angles(plan: Plan, sheet: Pdf) -> None:
    text = " ".join("".join(sheet.texts).replace("\N{MINUS SIGN}", "-").split())
    for pose in np.degrees(plan.q_rad.reshape(-1, 7)):
        assert " ".join(f"{angle:.1f}" if abs(angle) >= 0.05 else "0.0" for angle in pose) in text


def test_it_is_a4_across_tagged_and_has_room_for_the_hand(plan: Plan, sheet: Pdf) -> None:
    box = sheet.reader.pages[0].mediabox
    assert (round(float(box.width)), round(float(box.height))) == (842, 595)
    holds(sheet, "Work sheet", plan.arm.name, "Date", "Operator", "____", "443.172 mm")
    assert "/StructTreeRoot" in sheet.root
    assert len(sheet.alternatives()) == 3
    assert b"2026" not in sheet.metadata
    assert work_sheet(plan) == sheet.content


@pytest.mark.parametrize("language", LANGUAGES)
def test_it_is_in_every_language(plan: Plan, language: str) -> None:
    try:
        found = Pdf(work_sheet(plan, language))
    except ulna.UlnaInputError as error:
        pytest.skip(f"no font for it on this machine: {error}")
    words = dictionary(language)
    heads = ("title", "head-stand", "head-done", "head-remarks", "head-elbow", "date", "stands", "touches")
    holds(found, *(words[f"sheet.{key}"] for key in heads))


@pytest.mark.parametrize(("artefact", "touches"), [(SEAT, 3), (PLANE, 7), (BAR, 2)])
def test_other_artefacts_and_several_touches(artefact: ulna.Artefact, touches: int) -> None:
    plan = ulna.plan(limited(), spec(artefact, touches=touches, choose=30, candidates=1000))
    found = Pdf(work_sheet(plan))
    rows = plan.q_rad.size // 7
    assert "".join(found.texts).count("☐") == rows + len(plan.stands)
