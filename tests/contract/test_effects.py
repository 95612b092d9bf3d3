"""What every effect beyond geometry owes: one row of `ulna.arm.effects.effects`, one example here."""

from __future__ import annotations

import fnmatch
import tomllib
from abc import ABC
from dataclasses import replace
from importlib import resources
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.simulations import BAR, NOISE, off_over_u, saved, true_arm, write

import ulna
import ulna._core as _core
from ulna import Arm, Effects, Payload
from ulna.arm.arm import Arm as WholeArm
from ulna.arm.conditions import CONDITIONS, PAYLOAD
from ulna.arm.directions import drawn, unit_of
from ulna.arm.effects.effect import Effect
from ulna.arm.effects.effects import EFFECTS, NONE, effect_named, extra_of, with_extras
from ulna.ground.owed import missing
from ulna.simulation.study_files import readings_table

#: of joint k of seven, as large as those of real arms
EXAMPLES: dict[str, list[Effects]] = {
    "encoder-harmonics": [Effects({1: (2e-5 * (k + 1), -3e-5), 2: (1e-5, 2e-5)}) for k in range(7)],
    "link-expansion": [Effects(expansion_per_k=1.2e-5 + 1e-6 * k) for k in range(7)],
    "compliance": [
        Effects(compliance_rad_per_nm=2e-6 * (k + 1), mass_kg=0.8, centre_mm=(0.0, 10.0, -60.0)) for k in range(7)
    ],
    "backlash": [Effects(backlash_rad=1e-4 + 2e-5 * k) for k in range(7)],
    "base-tilt": [Effects(base_tilt_rad=(0.004, -0.007)), *[NONE] * 6],
    "base-offset": [Effects(base_offset_mm=(0.6, -1.1)), *[NONE] * 6],
    "coupling": [
        Effects(coupled_to=coupled_to, coupling=ratios)
        for coupled_to, ratios in [
            *[((), None)] * 2,
            ((2,), (-0.9,)),
            *[((), None)] * 2,
            ((2, 5), (0.02, 1.1)),
            ((), None),
        ]
    ],
}

#: coordinates in the base frame
POINTS = """[artefact.tracker]
kind = "points"
frame = "arm"
u = 0.002
features = { a = [500, 0, 300], b = [0, 550, 200], c = [-450, 100, 500], d = [-100, -500, 100], e = [300, 300, 600] }
"""

#: how a simulation is told what the effect depends on, where there is something to tell
TOLD: dict[str, str] = {
    "temperature": "temperature = { mean = 22.0, spread = 4.0 }\n",
    "approach": "",
    "payload": 'carried = ["none", "light", "heavy"]\n',
}

#: of an arm whose tip depends on what it carries
LOADS = {"light": Payload(2.0, (0.0, 5.0, 40.0)), "heavy": Payload(6.0, (-20.0, 0.0, 90.0))}

#: the same of poses
STATED = {
    "temperature": (22.0, 4.0),
    "approach": None,
    "payload": np.array([each.numbers for each in LOADS.values()]),
}

#: what may be left to the general answer is not here
OWED = {
    "name": "the word by which studies ask for it",
    "table": "its keys of a joint table",
    "suffixes": "the last parts of its parameters' names",
    "examples": "such names",
    "unit": "what its parameters are measured in",
    "drawn": "what may be of a parameter before anybody has measured",
    "does": "what the arm's parts do",
    "words": "what formats do not carry that have no place for it",
    "left_out": "what figures do not cover of an arm without it",
    "has": "whether a joint has it",
    "zero": "zero of it",
    "none": "an arm without it",
    "read": "how it is read from a joint's table",
    "written": "how it is written there",
    "for_core": "what it gives the core",
    "taken": "what it takes back",
}

DOCS = Path(__file__).parents[2] / "docs"

each_effect = pytest.mark.parametrize("effect", EFFECTS.values(), ids=str)
each_dependent = pytest.mark.parametrize("effect", [e for e in EFFECTS.values() if e.needs is not None], ids=str)


def affected(effect: Effect) -> Arm:
    assert effect.name in EXAMPLES, f"effect '{effect.name}' has no example here: add one to EXAMPLES"
    arm, own = true_arm(), EXAMPLES[effect.name]
    joints = tuple(replace(joint, effects=each) for joint, each in zip(arm.joints, own, strict=True))
    return replace(arm, joints=joints, payloads=LOADS if effect.needs is PAYLOAD else {})


def poses(count: int = 12) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """And every condition that there may be."""
    rng = np.random.default_rng(3)
    drawn_of = {each.said: each.drawn(count, 1, 7, STATED[each.name], rng) for each in CONDITIONS}
    said = {each.said: each.of_touches(drawn_of[each.said], 1) for each in CONDITIONS}
    return rng.uniform(-1.5, 1.5, (count, 7)), said


def own_parameters(arm: Arm, effect: Effect) -> list[int]:
    return [k for k, name in enumerate(arm.parameter_names) if extra_of(name) == effect.name]


def spec(folder: Path, effect: Effect, placements: int = 600) -> Path:
    told = TOLD[effect.needs.name] if effect.needs is not None else ""
    fit = f'fit = {{ extras = ["{effect.name}"], judge_extras = false }}'
    # where the arm stands shows in coordinates of its base frame alone
    touched = f"{POINTS}touches = 60\n" if effect.of_first else BAR + f"placements = {placements}\n"
    return write(folder, touched, f"{NOISE}\n{told}{fit}", affected(effect))


@each_effect
def test_nothing_is_missing(effect: Effect) -> None:
    assert missing("effect", type(effect), OWED) == []
    assert type(effect).__doc__
    arm = affected(effect)
    assert arm.extras == [effect.name]
    names = [arm.parameter_names[k] for k in own_parameters(arm, effect)]
    assert len(names) == len(arm.parameter_names) - len(true_arm().parameter_names)
    assert {arm.parameter_units[arm.parameter_names.index(name)] for name in names} == {effect.unit}
    assert {unit_of(name) for name in names} == {effect.unit}
    assert {drawn(name) for name in names} == {effect.drawn}
    assert {name.rsplit(".", 1)[1] for name in names} == set(effect.examples)


def test_what_is_missing_is_said_in_words() -> None:
    class Wear(Effect, ABC):
        name = "wear"
        unit = "rad"

    lacks = missing("effect", Wear, OWED)
    assert "effect 'wear' lacks read: how it is read from a joint's table" in lacks
    assert "effect 'wear' lacks table: its keys of a joint table" in lacks
    assert not any("lacks unit" in each for each in lacks)


def test_an_effect_that_there_is_not_is_an_error() -> None:
    with pytest.raises(ulna.UlnaInputError, match=r"there is no effect 'complaince'; expected .*compliance"):
        effect_named("complaince")
    with pytest.raises(_core.UlnaError, match="complaince"):
        true_arm().core.with_effects([("complaince", {})])


def test_no_two_say_the_same_keys_or_names() -> None:
    keys = [key for effect in EFFECTS.values() for key in effect.table.model_fields]
    assert len(keys) == len(set(keys))
    for effect in EFFECTS.values():
        for example in effect.examples:
            name = f"joint.3.{example}"
            assert [e for e in EFFECTS.values() if any(fnmatch.fnmatchcase(name, p) for p in e.patterns)] == [effect]


@each_effect
def test_arm_files_come_back_as_they_were(effect: Effect, tmp_path: Path) -> None:
    arm = affected(effect)
    arm.save(tmp_path / "arm.toml")
    assert WholeArm.load(tmp_path / "arm.toml").joints == arm.joints
    assert arm.with_parameters(arm.parameters).joints == arm.joints
    plain = "".join(joint_keys(true_arm(), tmp_path / "plain.toml"))
    assert {key for key in joint_keys(arm, tmp_path / "again.toml") if key not in plain} <= set(
        effect.table.model_fields
    )


def joint_keys(arm: Arm, path: Path) -> list[str]:
    arm.save(path)
    return [line.split(" = ")[0] for line in path.read_text().splitlines() if " = " in line]


@each_effect
def test_the_core_takes_and_gives_the_same_numbers(effect: Effect) -> None:
    arm = affected(effect)
    moved = arm.parameters.copy()
    own = own_parameters(arm, effect)
    moved[own] += np.linspace(1.0, 2.0, len(own)) * 1e-6
    again = arm.with_parameters(moved)
    np.testing.assert_array_equal(again.parameters, moved)
    np.testing.assert_array_equal(arm.core.with_parameters(moved).parameters, again.core.parameters)


@each_effect
def test_zero_of_it_changes_nothing(effect: Effect) -> None:
    plain, (q_rad, said) = true_arm(), poses()
    # what is known of it from the design stays, such as to which a joint is coupled
    drawn_only = [replace(own, **effect.none()) for own in EXAMPLES[effect.name]]
    effects = with_extras(drawn_only, [effect.name], [1, 2])
    joints = [replace(joint, effects=own) for joint, own in zip(plain.joints, effects, strict=True)]
    arm = replace(plain, joints=tuple(joints))
    assert arm.extras == [effect.name]
    np.testing.assert_array_equal(arm.tip(q_rad, **said), plain.tip(q_rad))
    without = [replace(own, **effect.none()) for own in EXAMPLES[effect.name]]
    assert not any(effect.has(own) for own in without)
    assert not effect.has(NONE)


@each_effect
def test_derivatives_are_those_of_finite_differences(effect: Effect) -> None:
    arm, (q_rad, said) = affected(effect), poses()
    found = arm.jacobian(q_rad, **said)
    for k in own_parameters(arm, effect):
        step = 1e-3 * effect.drawn
        ends = []
        for sign in (1.0, -1.0):
            moved = arm.parameters.copy()
            moved[k] += sign * step
            ends.append(arm.with_parameters(moved).tip(q_rad, **said))
        slope = (ends[0] - ends[1]) / (2.0 * step)
        scale = max(1.0, float(np.abs(slope).max()))
        np.testing.assert_allclose(found[:, :, k] / scale, slope / scale, rtol=0, atol=1e-7)


@each_effect
def test_a_calibration_with_it_finds_it(effect: Effect, tmp_path: Path) -> None:
    """Of an arm that was drawn without it; and without it chi² says that something is wrong."""
    simulated, study = saved(spec(tmp_path, effect))
    assert study.arm.extras == []
    result = ulna.calibrate(study)
    off = off_over_u(simulated, result)
    own = [row for row in result.parameters if extra_of(row.name) == effect.name and row.status == "fitted"]
    assert len(own) >= len(own_parameters(simulated.truth.arm, effect)) - 2
    assert np.abs(off).max() < 4.5
    assert result.fit.chi2_per_dof == pytest.approx(1.0, abs=0.15)
    without = ulna.calibrate(study, extras=[])
    assert without.fit.chi2_per_dof is not None
    assert without.fit.chi2_per_dof > 1.5


@each_dependent
def test_a_condition_that_is_missing_is_named(effect: Effect, tmp_path: Path) -> None:
    arm, (q_rad, _) = affected(effect), poses()
    condition = effect.needs
    assert condition is not None
    with pytest.raises(ulna.UlnaInputError, match=f"{effect.whose} {effect.does}.*{condition.name}"):
        arm.tip(q_rad)
    simulated, _ = saved(spec(tmp_path, effect, 60))
    (group,) = simulated.study.readings
    table = readings_table(group, list(arm.probes), None, arm.payloads)
    table.select(c for c in table.columns if not c.startswith(condition.name)).write_csv(tmp_path / "out" / "bar.csv")
    with pytest.raises(ulna.UlnaInputError, match=f"bar.csv.*{condition.unsaid}.*{condition.name}.*{effect.name}"):
        ulna.calibrate(ulna.Study.load(tmp_path / "out" / "study.toml"))
    with pytest.raises(ulna.UlnaInputError, match=f"no column '{condition.name}"):
        ulna.measure(arm, tmp_path / "out" / "bar.csv")


@each_dependent
def test_measured_points_are_those_of_the_condition(effect: Effect, tmp_path: Path) -> None:
    arm = affected(effect)
    simulated, study = saved(spec(tmp_path, effect, 20))
    (group,) = study.readings
    points = ulna.measure(arm, tmp_path / "out" / "bar.csv").table
    assert isinstance(points, pl.DataFrame)
    expected = arm.tip(group.q_rad, **group.said[0])
    np.testing.assert_allclose(points.select("x", "y", "z").to_numpy(), expected, rtol=0, atol=1e-9)
    assert np.abs(expected - true_arm().tip(group.q_rad)).max() > 1e-3
    assert simulated.study.readings[0].said[0].keys() == group.said[0].keys()


@each_effect
def test_every_language_has_words_for_it(effect: Effect) -> None:
    for language in (
        each for each in resources.files("ulna.documents.languages").iterdir() if each.name.endswith(".toml")
    ):
        words = tomllib.loads(language.read_text(encoding="utf-8"))
        for key in (f"extra.{effect.name}", *(f"cause.{cause}" for cause in effect.causes)):
            assert key in words, f"{language.name} lacks {key}"


@each_effect
def test_the_documentation_names_it(effect: Effect) -> None:
    assert f"`{effect.name}`" in (DOCS / "concepts" / "effects.md").read_text()
    reference = (DOCS / "reference" / "files.md").read_text()
    for key in effect.table.model_fields:
        assert f"joint.{key}" in reference or f"`{key}`" in reference, key
