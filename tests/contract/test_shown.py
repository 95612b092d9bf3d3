"""Every object that shows itself does so in one screen, says first what it is, and looks the same on any page."""

from __future__ import annotations

import dataclasses
import importlib
import pkgutil
import re
import warnings
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import ulna
from ulna.arm.covariance import ParameterCovariance
from ulna.ground.shown import WIDE, About, Shown, Table, as_html, as_text

PLATINUM = Path(__file__).resolve().parents[2] / "examples" / "platinum"
SMALL_PLAN = "[plan]\nchoose = 40\ncandidates = 1000\ntrials = 0\n"
MOST_LINES = 40
"""Of a screen."""


def shown_classes() -> set[type]:
    """All that show themselves, wherever in the package."""
    for module in pkgutil.walk_packages(ulna.__path__, "ulna."):
        if not module.name.startswith(("ulna.__main__", "ulna.cli")):
            importlib.import_module(module.name)

    def below(one: type) -> set[type]:
        return {one}.union(*(below(each) for each in one.__subclasses__()))

    return {each for each in below(Shown) if not getattr(each, "__abstractmethods__", None)}


@pytest.fixture(scope="module")
def objects(tmp_path_factory: pytest.TempPathFactory) -> dict[type, Any]:
    """One of each, made in the usual way."""
    from ulna.verification.test_plan import play_test_plan

    folder = tmp_path_factory.mktemp("shown")
    study = ulna.Study.load(PLATINUM / "study.toml")
    result = ulna.calibrate(study)
    play_test_plan("iso-10360-12", PLATINUM / "truth.toml").save(folder / "test")
    simulation = folder / "simulation.toml"
    simulation.write_text(
        f'format = "ulna-simulation/1"\narm = "{PLATINUM / "platinum.toml"}"\n'
        'units = { length = "mm", angle = "rad" }\nseed = 1\n'
        '[artefact.bar]\nkind = "bar"\nlength = 443.172\nplacements = 20\n'
    )
    (folder / "studies").mkdir()
    (folder / "studies" / "one.toml").write_text(
        (PLATINUM / "study.toml")
        .read_text()
        .replace('"platinum.toml"', f'"{PLATINUM / "platinum.toml"}"')
        .replace('"bars.csv"', f'"{PLATINUM / "bars.csv"}"')
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ulna.InputWarning)
        simulated = ulna.simulate(simulation)
    q = np.full((3, 7), 0.4) + np.arange(3)[:, None] * 0.1
    records = ulna.Records.init(folder / "bench", by="Jan")
    records.register("P7")
    found: list[Any] = [
        study,
        records,
        study.arm,
        study.readings[0],
        study.readings[0].artefact,
        result,
        result.covariance,
        result.identifiability,
        ulna.evaluate(result, PLATINUM / "check.toml"),
        ulna.cross_validate(study, by=2),
        ulna.measure(result, q),
        ulna.measure(result, PLATINUM / "length.csv"),
        ulna.uncertainty(result, PLATINUM / "length.toml", most_trials=0),
        ulna.volume_uncertainty(result, fewer(folder, "volume.toml", "")),
        ulna.plan(PLATINUM / "platinum.toml", fewer(folder, "plan.toml", SMALL_PLAN)),
        simulated,
        ulna.verify(folder / "test" / "plan.toml", result),
        ulna.check(PLATINUM / "protocol.toml", PLATINUM / "morning-11-02.csv"),
        ulna.batch(folder / "studies", folder / "out"),
    ]
    return {type(each): each for each in found}


def fewer(folder: Path, name: str, changed: str) -> Path:
    """A file of the example with other numbers, so that it takes no time."""
    text = (PLATINUM / name).read_text().partition("[plan]")[0]
    text = text.replace("[travel]", "points = 400\nbars = 100\n\n[travel]") if name == "volume.toml" else text
    path = folder / name
    path.write_text(text + changed)
    return path


def test_all_that_show_themselves_are_here(objects: dict[type, Any]) -> None:
    assert {each.__name__ for each in shown_classes()} == {each.__name__ for each in objects}


def test_one_screen_and_what_it_is_first(objects: dict[type, Any]) -> None:
    for kind, each in objects.items():
        lines = repr(each).splitlines()
        assert len(lines) <= MOST_LINES, f"{kind.__name__}: {len(lines)} lines"
        assert max(map(len, lines)) <= WIDE + 20, f"{kind.__name__}: {max(lines, key=len)}"
        assert re.match(r"[A-Z0-9]", lines[0]), lines[0]
        assert not re.search(r"array\(|=\[|object at 0x|dtype", repr(each)), f"{kind.__name__} dumps its fields"
    arm = next(each for kind, each in objects.items() if kind is ulna.Arm)
    assert repr(arm).startswith("Arm 'virtual Platinum, seven axes, bent probe': 7 joints, reach 1245 mm\n")


def test_html_is_whole_and_has_no_colour_of_its_own(objects: dict[type, Any]) -> None:
    for kind, each in objects.items():
        page = each._repr_html_()
        ElementTree.fromstring(page.replace("&nbsp;", " "))
        assert not re.search(r"(?<![-\w])(color|background)\s*:", page), f"{kind.__name__}: colours break on dark pages"
        first = repr(each).splitlines()[0]
        words = re.sub(r"<[^>]+>|&#x27;|'|\s", "", page)
        assert re.sub(r"'|\s", "", first)[:30] in words, kind.__name__


def test_names_of_others_are_text(objects: dict[type, Any]) -> None:
    evil = "<script>alert(1)</script>\n\x1b[31m\u202e"
    arm = dataclasses.replace(objects[ulna.Arm], name=evil)
    assert "<script>" not in arm._repr_html_()
    assert "\x1b" not in repr(arm)
    assert "\u202e" not in repr(arm)
    assert repr(arm).splitlines()[1].startswith("  ")


def test_long_tables_are_cut_and_say_so() -> None:
    about = About("Things", {}, [Table(["thing", "mm"], [[str(k), f"{k}.5"] for k in range(100)])], ["a remark."] * 9)
    text = as_text(about)
    assert "… 90 more …" in text
    assert "  99     99.5" in text.splitlines()
    assert "and 5 more remarks" in text
    assert len(text.splitlines()) < 20
    page = as_html(about)
    assert "… 70 more …" in page
    assert page.count("<tr>") == 1 + 30 + 1


def test_letters_of_east_asia_take_two_columns() -> None:
    rows = as_text(About("x", {}, [Table(["name", "mm"], [["测量臂", "1"], ["ab", "22"]])])).splitlines()[1:]
    assert rows == ["  name    mm", "  测量臂   1", "  ab      22"]


def test_a_lost_direction_is_a_remark() -> None:
    lost = [{"combination": {"joint.1.d": 1.0}, "because": "nothing tells it", "remedy": "r", "frame": False}]
    shown = repr(ParameterCovariance(["joint.1.a"], np.array([[4.0]]), lost))
    assert shown.splitlines() == [
        "Covariance of 1 parameters, mm and rad, 1 directions not determined",
        "  parameter    u",
        "  joint.1.a  2.0",
    ]
