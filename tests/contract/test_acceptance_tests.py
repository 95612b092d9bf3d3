"""What every kind of acceptance test owes, held against each row of the registry and each of its examples.

A new kind is held to all of this by its row alone: its example tables are all that the suite needs.
"""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from pydantic import BaseModel, TypeAdapter, ValidationError
from tests.cli_runs import platinum

import ulna
from ulna.arm.arm import Arm
from ulna.arm.probe import Probe
from ulna.documents.languages.languages import LANGUAGES
from ulna.documents.languages.words import dictionary
from ulna.formats.models import OneOf, Strict
from ulna.formats.toml_text import toml_key, toml_value
from ulna.ground.errors import UlnaInputError
from ulna.verification.as_it_falls import so_far
from ulna.verification.file import load_verify
from ulna.verification.kinds.kind import TestKind, TestTable
from ulna.verification.kinds.registry import KINDS, by_name, kind_of
from ulna.verification.kinds.steps import Step
from ulna.verification.plan_files import touches_table
from ulna.verification.player import Played, play
from ulna.verification.profile import Profile, load_profile
from ulna.verification.profile_tables import ProfileFile
from ulna.verification.steps import steps_of
from ulna.verification.test_plan import TestPlan, make_test_plan
from ulna.verification.to_touch import work_list
from ulna.verification.verify import Verification

HEAD = (
    'format = "ulna-profile/1"\nname = "own"\nstandard = "none"\nstatement = "An example."\n'
    '[decision]\nrule = "simple"\nk = 2.0\np = 0.95\n'
)
SIGMA_MM = 1e-5
"""Of a touch: so small that a gauge's face, 8 mm wide, tilts by nothing that its length would show."""
EXAMPLES = [
    pytest.param(kind, table, id=f"{name}-{number}")
    for name, kind in KINDS.items()
    for number, table in enumerate(kind.examples(), start=1)
]
every_example = pytest.mark.parametrize(("kind", "table"), EXAMPLES)
every_kind = pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)


@pytest.fixture(scope="module")
def truth() -> Arm:
    tip = platinum().probes["bent"]
    return platinum({"bent": Probe(tip.x_mm, tip.y_mm, tip.z_mm, ball_mm=6.0)})


def profile_with(folder: Path, table: TestTable) -> Path:
    path = folder / "own.toml"
    keys = "".join(f"{key} = {toml_value(value)}\n" for key, value in table.model_dump(exclude_none=True).items())
    path.write_text(f"{HEAD}[test.it]\n{keys}", encoding="utf-8")
    return path


def evaluated(folder: Path, profile: Profile, played: Played, true: Arm) -> Verification:
    """What verify says of played touches; certificates state the true sizes, so that what is left is the arm's."""
    stated: dict[str, Any] = {name: dict(keys) for name, keys in played.filled.artefacts.items()}
    for each in kind_of(profile.file.test["it"].kind).artefacts(profile.file.test["it"]):
        if each.SIZE is not None:
            stated[each.name][each.SIZE] = played.truth[each.name]
    columns = {f"q{k + 1}": played.q_rad[:, k] for k in range(true.n)}
    filled = dataclasses.replace(played.filled, artefacts=stated)
    TestPlan(profile, filled, True, touches_table(profile, columns)).save(folder, force=True)
    true.save(folder / "arm.toml", force=True)
    return ulna.verify(folder / "plan.toml", folder / "arm.toml")


def values(found: Verification) -> dict[str, list[float]]:
    """Single values by the short name of their figure."""
    return {
        figure.definition.key: [judged.single.value_mm for judged in figure.values]
        for figure in found.states[0].figures.values()
    }


@every_example
def test_a_profile_with_it_is_read_back(kind: TestKind[Any], table: TestTable, tmp_path: Path) -> None:
    read = load_profile(profile_with(tmp_path, table).name, tmp_path, "").file.test["it"]
    assert read == table
    assert type(read) is kind.table
    again = ProfileFile.model_validate(load_profile("own.toml", tmp_path, "").file.model_dump())
    assert again.test["it"] == table


@every_example
def test_what_is_wrong_in_its_table_is_told(kind: TestKind[Any], table: TestTable, tmp_path: Path) -> None:
    """A key that is not known, with the nearest one of this very table; and each needed key that is missing."""
    path = profile_with(tmp_path, table)
    text = path.read_text(encoding="utf-8")
    keys = [key for key in table.model_dump(exclude_none=True) if key != "kind"]
    for key in keys:
        path.write_text(text.replace(f"\n{key} =", f"\n{key}x ="), encoding="utf-8")
        with pytest.raises(UlnaInputError, match=rf"unknown key 'test\.it\.{key}x'\. Did you mean '{key}'\?"):
            load_profile("own.toml", tmp_path, "")
        if kind.table.model_fields[key].is_required():
            path.write_text(re.sub(rf"\n{key} = .*", "", text), encoding="utf-8")
            with pytest.raises(UlnaInputError, match=rf"key 'test\.it\.{key}' is missing\. Add it\."):
                load_profile("own.toml", tmp_path, "")


@every_example
def test_its_list_says_what_to_do(kind: TestKind[Any], table: TestTable, tmp_path: Path) -> None:
    made = make_test_plan(profile_with(tmp_path, table).name, beside=tmp_path)
    assert len(made.table) >= 2
    assert all(made.table["what to do"].to_list())
    text = made.text(tmp_path)
    for figure in kind.figures(table):
        assert f"\n# {toml_key(figure.key)} = " in text, "a limit to be filled in"
    for each in kind.artefacts(table):
        head = f"[artefact.{toml_key(each.name)}]"
        assert (head in text) == (each.SIZE is not None), "an artefact to be filled in, where a certificate is about it"


@every_example
def test_an_exact_arm_finds_nothing(kind: TestKind[Any], table: TestTable, truth: Arm, tmp_path: Path) -> None:
    """Planned, played without noise, evaluated: all values are 0, all limits kept, all counts those of the profile."""
    profile = load_profile(profile_with(tmp_path, table).name, tmp_path, "")
    found = evaluated(tmp_path, profile, play(profile, truth, 0.0, 0.0, seed=1), truth)
    every = values(found)
    assert list(every) == [figure.key for figure in kind.figures(table)]
    for key, each in every.items():
        assert np.abs(each).max() < 1e-6, key
    assert [text for test in found.states[0].tests for text in test.departures] == []
    verdicts = {figure.definition.key: figure.verdict for figure in found.states[0].figures.values()}
    assert verdicts == {key: "pass" if key in kind.limits else None for key in every}
    lengths = [judged.single.measured_mm for judged in next(iter(found.states[0].figures.values())).values]
    assert ("lengths.svg" in found.files) == (kind.length_errors and None not in lengths)


@every_example
def test_its_values_fall_while_it_is_touched(kind: TestKind[Any], table: TestTable, truth: Arm, tmp_path: Path) -> None:
    """Step by step: a measurement that is whole has the values of the whole test, and none is taken for another step;
    where a kind grows, its values are those of as many touches."""
    profile = load_profile(profile_with(tmp_path, table).name, tmp_path, "")
    whole = evaluated(tmp_path, profile, play(profile, truth, 1e-6, 0.002, seed=3), truth)
    plan = load_verify(tmp_path / "plan.toml", tmp_path / "arm.toml")
    work = work_list(plan, next(iter(truth.probes.values())).ball_mm)
    work.check("as-left")
    assert work.steps == steps_of(profile.file)
    (touches,) = plan.touches["as-left"]
    final = {(key, one) for key, each in values(whole).items() for one in each}
    for count in range(1, len(work.listed) + 1):
        at_mm = touches.p_mm[count - 1]
        earlier = {k: touches.p_mm[k] for k in range(count - 1)}
        assert work.unlikely(count - 1, at_mm, earlier) is None
        rows = np.arange(count)
        some = dataclasses.replace(plan, touches={"as-left": [touches.where(rows)]})
        known = so_far(some, "as-left", work, rows.tolist())
        there = {(each.definition.key, each.judged.single.value_mm) for each in known.values}
        if count == len(work.listed):
            assert there == final
            assert known.not_yet == {}
        elif kind.growing is None and len({figure.key for figure in kind.figures(table)}) == 1:
            assert there <= final or kind.name == "articulation"
        elif kind.growing is not None:
            own = [part for part in work.parts if len(set(part) & set(range(count))) >= kind.growing]
            assert len(there) == len(own) * len(kind.figures(table))


@every_example
def test_noise_is_found_in_its_size(kind: TestKind[Any], table: TestTable, truth: Arm, tmp_path: Path) -> None:
    """Twice the noise is twice the value: small values are linear in the touches, and so are their extremes. And a
    figure is of the size of a touch's noise, neither a hundredth of it nor hundred times as much."""
    profile = load_profile(profile_with(tmp_path, table).name, tmp_path, "")
    sizes: dict[str, list[float]] = {}
    for seed in range(4):
        once, twice = (
            values(evaluated(tmp_path, profile, play(profile, truth, 0.0, sigma_mm, seed), truth))
            for sigma_mm in (SIGMA_MM, 2.0 * SIGMA_MM)
        )
        for key, each in once.items():
            assert twice[key] == pytest.approx([2.0 * value for value in each], rel=1e-2, abs=1e-7), key
            sizes.setdefault(key, []).append(float(np.abs(each).max()) / SIGMA_MM)
    for key, size in sizes.items():
        assert 0.2 < np.sqrt(np.mean(np.square(size))) < 10.0, key


@every_kind
def test_its_words_are_in_every_language(kind: TestKind[Any]) -> None:
    for language in LANGUAGES:
        assert set(kind.words) <= dictionary(language).keys()


@every_kind
def test_its_figures_say_what_they_are(kind: TestKind[Any]) -> None:
    for table in kind.examples():
        figures = kind.figures(table)
        assert len({figure.key for figure in figures}) == len({figure.name for figure in figures}) == len(figures)
        for figure in figures:
            assert re.fullmatch(r"\w+", figure.key)
            assert figure.formula
            assert figure.standard


def test_no_two_kinds_give_the_same_figure() -> None:
    """A limit is stated by a figure's short name alone."""
    owners: dict[str, set[str]] = {}
    for name, kind in KINDS.items():
        for table in kind.examples():
            for figure in kind.figures(table):
                owners.setdefault(figure.key, set()).add(name)
    assert [key for key, names in owners.items() if len(names) > 1] == []


SPHERE = KINDS["sphere"]


class Nameless(TestTable):
    """A table that forgot its name."""


class Undescribed(TestTable):
    kind: Literal["undescribed"]


SPHERE_TABLE = SPHERE.examples()[0]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"table": Nameless}, r"acceptance test Nameless: its table has no name: write kind: Literal\[…\]"),
        ({"table": Undescribed}, "acceptance test Undescribed: its table has no docstring: say which figures"),
        ({"look": ""}, "SphereTest: it does not say what to measure again, and what to look at"),
        ({"length_errors": True}, "SphereTest: it draws errors over lengths, but names no words for that: name their"),
        ({"examples": lambda: []}, "'sphere': it has no examples: give a small table of each variant"),
        ({"figures": lambda table: []}, "'sphere': it has no figures: name what it gives, with a formula and a source"),
        ({"limits": {"P_Sise": 1.0}}, "'sphere': it has an example of a limit for 'P_Sise', which no example gives"),
        ({"steps": lambda name, table: []}, "'sphere': it has no steps: say what the operator touches"),
        (
            {"steps": lambda name, table: [Step(name, "cube")]},
            "'sphere': a step touches 'cube', which is not among its artefacts: name it there",
        ),
    ],
)
def test_an_incomplete_kind_says_what_is_missing(change: dict[str, Any], told: str) -> None:
    with pytest.raises(TypeError, match=told):
        dataclasses.replace(SPHERE, **change).check()


@every_kind
def test_a_kind_is_whole(kind: TestKind[Any]) -> None:
    kind.check()


@pytest.mark.parametrize("part", [field.name for field in dataclasses.fields(TestKind)])
def test_no_part_of_a_kind_has_a_default(part: str) -> None:
    given = {field.name: getattr(SPHERE, field.name) for field in dataclasses.fields(SPHERE)}
    del given[part]
    with pytest.raises(TypeError, match=f"missing 1 required keyword-only argument: '{part}'"):
        TestKind(**given)


def test_a_figure_that_a_kind_does_not_own_to_is_told(truth: Arm, tmp_path: Path) -> None:
    other = dataclasses.replace(SPHERE, figures=KINDS["articulation"].figures, limits={})
    profile = load_profile(profile_with(tmp_path, SPHERE_TABLE).name, tmp_path, "")
    plan = evaluated(tmp_path, profile, play(profile, truth, 0.0, 0.0, seed=1), truth).plan
    with pytest.raises(TypeError, match="'sphere': it gives 'P_Size', which is not among its figures: name it there"):
        other.evaluated("it", SPHERE_TABLE, plan.touches["as-left"][0], plan.bench)


def test_two_kinds_of_one_name_are_told() -> None:
    with pytest.raises(TypeError, match="'sphere': SphereTest and SphereTest are both called so; give one another"):
        by_name([SPHERE, SPHERE])


def test_an_unknown_kind_is_told(tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match=r"of kind 'spere': this Ulna does not know it. Did you mean 'sphere'\?"):
        kind_of("spere")
    profile_with(tmp_path, SPHERE_TABLE.model_copy(update={"kind": "spere"}))
    with pytest.raises(UlnaInputError, match=r"key 'test.it.kind': got 'spere', expected .*Did you mean 'sphere'\?"):
        load_profile("own.toml", tmp_path, "")


def test_a_union_made_of_a_registry_is_one_written_by_hand() -> None:
    class First(Strict):
        kind: Literal["first"]
        size: float

    class Second(Strict):
        kind: Literal["second"]

    made: TypeAdapter[Any] = TypeAdapter(dict[str, OneOf({"first": First, "second": Second}).union])
    assert made.validate_python({"a": {"kind": "first", "size": 1.0}, "b": {"kind": "second"}}) == {
        "a": First(kind="first", size=1.0),
        "b": Second(kind="second"),
    }
    with pytest.raises(ValidationError):
        made.validate_python({"a": {"kind": "third"}})
    schema = made.json_schema()["additionalProperties"]
    assert {each["$ref"] for each in schema["oneOf"]} == {"#/$defs/First", "#/$defs/Second"}


def test_the_schema_of_profiles_has_every_kind() -> None:
    of_tests = ProfileFile.model_json_schema()["properties"]["test"]["additionalProperties"]["oneOf"]
    assert [each["$ref"] for each in of_tests] == [f"#/$defs/{kind.table.__name__}" for kind in KINDS.values()]
    assert all(issubclass(kind.table, BaseModel) for kind in KINDS.values())
