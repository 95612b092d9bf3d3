"""Studies of surfaces, priors and effects as files: what they say arrives, what cannot be is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.foreign_tables import WRITERS
from tests.small_study import ARM, SmallStudy, says

import ulna
from ulna import Arm, UlnaInputError
from ulna.study.assembly import assemble

MIXED = """\
format = "ulna-study/1"
arm = "arm.toml"
units = { length = "mm", angle = "deg" }

[[readings]]
file = "mixed.csv"
probe = "bent"

[artefact.ball]
kind = "sphere"
diameter = 25.0
u = 0.002

[artefact.flat]
kind = "plane"

[artefact.bar]
kind = "bar"
length = 400.0

[artefact.cone]
kind = "seat"

[fit]
"""
#: q, artefact, placement, feature: as a spreadsheet has it, the last column blank where it says nothing
ROWS = [("ball", "1", "")] * 6 + [("flat", "1", "")] * 5 + [("bar", "1", "A"), ("bar", "1", "B"), ("cone", "1", "")]


def mixed(folder: Path, rows: list[tuple[str, str, str]] = ROWS, text: str = MIXED) -> SmallStudy:
    small = SmallStudy(folder)
    q = np.random.default_rng(1).uniform(-80, 80, (len(rows), 3)).round(4).tolist()
    lines = ["q1,q2,q3,artefact,placement,feature"]
    lines += [",".join([*map(str, angles), *row]) for angles, row in zip(q, rows, strict=True)]
    small.write("mixed.csv", "\n".join(lines) + "\n")
    small.write("study.toml", text)
    return small


def test_surfaces_bars_and_seats_in_one_table(tmp_path: Path) -> None:
    study, warned = mixed(tmp_path).load()
    assert warned == []
    ball, flat, bar, cone = study.readings
    assert (ball.artefact.kind, ball.artefact.diameter_mm, ball.artefact.u_mm) == ("sphere", 25.0, 0.002)
    assert (flat.artefact.kind, len(flat), bar.feature.tolist(), cone.feature.tolist()) == ("plane", 5, [0, 1], [0])
    assembled = assemble(study)
    assert assembled.names == study.arm.parameter_names
    fitted = ulna.calibrate(study, free=["joint.1.alpha", "probe.bent.z"])
    assert fitted.residuals["distance_mm"].is_not_null().sum() == 11
    assert fitted.residuals["feature"].is_not_null().sum() == 3


@pytest.mark.parametrize("kind", ["table.parquet", "book.xlsx", "semicolons.csv"])
def test_blank_features_in_other_formats(tmp_path: Path, kind: str) -> None:
    import polars as pl

    small = mixed(tmp_path)
    table = pl.read_csv(tmp_path / "mixed.csv", schema_overrides={"placement": pl.String})
    keys = WRITERS[kind](table, tmp_path / kind)
    small.write("study.toml", MIXED.replace('file = "mixed.csv"', f'file = "{kind}"\n{keys}'))
    study, _ = small.load()
    assert [len(group) for group in study.readings] == [6, 5, 2, 1]


def test_a_blank_feature_of_a_bar_is_told(tmp_path: Path) -> None:
    rows = [*ROWS[:-3], ("bar", "1", "A"), ("bar", "1", ""), ("cone", "1", "")]
    says(mixed(tmp_path, rows).error(), "mixed.csv: row 13 (line 14", "column 'feature': the cell is empty", "Fill it")


CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "no diameter": ("diameter = 25.0\n", "", ("'artefact.ball.diameter' is missing",)),
    "diameter of zero": ("diameter = 25.0", "diameter = 0", ("'artefact.ball.diameter'", "greater than 0")),
    "a plane with a length": ('"plane"', '"plane"\nlength = 3', ("unknown key 'artefact.flat.length'",)),
    "a bar to fit without u": (
        *("length = 400.0", "length = 400.0\nfit = true"),
        ("'artefact.bar.fit'", "u is not stated", "Add u, or remove the key"),
    ),
    "a loss": ("[fit]", '[fit]\nloss = "huberr"', ("'fit.loss'", "'huberr'", "'huber'")),
    "a method": ("[fit]", '[fit]\nmethod = "genetic"', ("'fit.method'", "'genetic'", "'annealing' or 'evolution'")),
    "a budget": ("[fit]", "[fit]\nbudget = 10", ("'fit.budget'", "got 10", "at least 100")),
    "harmonics that fall": ("[fit]", "[fit]\nharmonics = [2, 1]", ("'fit.harmonics'", "[2, 1]", "ascending")),
    "harmonics of none": ("[fit]", "[fit]\nharmonics = []", ("'fit.harmonics'", "at least 1")),
    "an order of nought": ("[fit]", "[fit]\nharmonics = [0]", ("'fit.harmonics.1'", "got 0", "at least 1")),
    "a prior of nothing": (
        *("[fit]", '[fit]\nprior = { "joint.9.a" = 1 }'),
        ("'fit.prior'", "'joint.9.a' matches no parameter", "joint.1.theta0"),
    ),
    "a prior without a deviation": (
        *("[fit]", '[fit]\nprior = { "joint.1.a" = { value = 3 } }'),
        ("'fit.prior.joint.1.a.u' is missing",),
    ),
    "a prior of zero": ("[fit]", '[fit]\nprior = { "joint.1.a" = 0 }', ("'fit.prior.joint.1.a'", "greater than 0")),
    "a block not asked for": (
        *("[fit]", '[fit]\nhold = ["joint.1.c1"]'),
        ("'fit.hold'", "'joint.1.c1'", "Is 'encoder-harmonics' missing in fit.extras?"),
    ),
    "a box of nothing": ("[fit]", "[fit]\nbox_length = 0", ("'fit.box_length'", "greater than 0")),
}


@pytest.mark.parametrize("case", CASES)
def test_what_a_study_is_told(tmp_path: Path, case: str) -> None:
    old, new, fragments = CASES[case]
    small = mixed(tmp_path)
    small.swap("study.toml", old, new)
    says(small.error(), str(tmp_path), *fragments)


def test_a_ball_without_a_size_is_told_with_the_probe(tmp_path: Path) -> None:
    small = mixed(tmp_path)
    small.swap("study.toml", 'probe = "bent"', 'probe = "straight"')
    study, _ = small.load()
    with pytest.raises(UlnaInputError) as raised:
        ulna.calibrate(study)
    says(str(raised.value), "artefact 'ball'", "probe 'straight'", "no diameter", "probe.straight.ball", "Add it")


def test_a_ball_larger_than_the_hollow_is_told(tmp_path: Path) -> None:
    small = mixed(tmp_path)
    small.swap("study.toml", "diameter = 25.0", "diameter = 5.0\ninside = true")
    study, _ = small.load()
    with pytest.raises(UlnaInputError) as raised:
        ulna.calibrate(study)
    says(str(raised.value), "'ball' is a hollow of 5 mm", "probe 'bent' has 6 mm", "a smaller ball")


ARM_CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "a harmonic of no name": (
        *("d = 1.5", "d = 1.5\nharmonics = { k1 = 0.1 }"),
        ("'joint.2.harmonics.k1'", "c1, s1, c2, s2", "from 1 to 100"),
    ),
    "an order of a thousand": ("d = 1.5", "d = 1.5\nharmonics = { c1000 = 0.1 }", ("'joint.2.harmonics.c1000'",)),
    "compliance of nothing": (
        *("d = 1.5", "d = 1.5\ncompliance = 1e-5"),
        ("'joint.2.compliance'", "no joint has a mass", "Add them, or remove the key"),
    ),
    "a mass below nothing": ("d = 1.5", "d = 1.5\nmass = -1", ("'joint.2.mass'", "got -1", "at least 0")),
    "half a centre": ("d = 1.5", "d = 1.5\nmass = 1\ncentre = [1, 2]", ("'joint.2.centre'", "at least 3")),
    "no gravity": ('name = "three axes"', "gravity = [0, 0, 0]", ("'gravity'", "no direction", "[0, 0, -1]")),
    "a full last link without one": (
        *('name = "three axes"', "full_last_link = true"),
        ("'joint.3.theta0' is missing", "Add it"),
    ),
}


@pytest.mark.parametrize("case", ARM_CASES)
def test_what_an_arm_is_told(tmp_path: Path, case: str) -> None:
    old, new, fragments = ARM_CASES[case]
    path = tmp_path / "arm.toml"
    path.write_text(ARM.replace(old, new, 1))
    with pytest.raises(UlnaInputError) as caught:
        Arm.load(path)
    says(str(caught.value), f"{path}: ", *fragments)


def test_effects_are_written_as_they_were_read(tmp_path: Path) -> None:
    text = ARM.replace("d = 1.5", "d = 1.5\nharmonics = { c1 = 1e-4, s2 = -2e-4 }\nexpansion = 1.1e-5", 1)
    text = text.replace("a = 40.0", "a = 40.0\ncompliance = 2e-6\nmass = 3.5\ncentre = [1.0, 2.0, 30.0]", 1)
    (tmp_path / "arm.toml").write_text(text.replace('name = "three axes"', 'name = "x"\ngravity = [0.0, 1.0, -1.0]'))
    arm = Arm.load(tmp_path / "arm.toml")
    arm.save(tmp_path / "again.toml")
    again = Arm.load(tmp_path / "again.toml")
    assert again == arm
    np.testing.assert_array_equal(again.parameters, arm.parameters)
    assert arm.extras == ["encoder-harmonics", "link-expansion", "compliance"]
    assert arm.joints[1].effects.harmonics_rad == {1: (1e-4, 0.0), 2: (0.0, -2e-4)}


def test_options_from_python_have_the_same_limits(tmp_path: Path) -> None:
    study, _ = mixed(tmp_path).load()
    for options, fragments in (
        ({"loss": "l1"}, ("'fit.loss'", "'l1'", "'huber'")),
        ({"method": "lma"}, ("'fit.method'", "Did you mean 'lm'?")),
        ({"extras": ["harmonics"]}, ("'fit.extras'", "'harmonics'", "'encoder-harmonics'")),
        ({"budget": 1}, ("'fit.budget'", "100 to")),
        ({"prior": {"joint.1.a": ulna.Prior(-1.0)}}, ("'fit.prior'", "-1.0", "a positive number")),
        ({"harmonics": []}, ("'fit.harmonics'", "ascending")),
    ):
        with pytest.raises(UlnaInputError) as raised:
            ulna.calibrate(study, **options)
        says(str(raised.value), *fragments)
