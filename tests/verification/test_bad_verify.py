"""What `ulna verify` cannot use is told in one message, with exit code 2 and nothing written."""

from __future__ import annotations

from pathlib import Path

import polars as pl
import pytest
from tests.acceptance import BALL, iso_rows, write_plan
from tests.cli_runs import assert_bad_input, platinum, run

import ulna
from ulna.ground.errors import UlnaInputError


def told(path: Path, arm: Path | None = None) -> str:
    with pytest.raises(UlnaInputError) as error:
        ulna.verify(path, arm)
    return str(error.value)


@pytest.mark.parametrize(
    ("part", "text", "expected"),
    [
        ("head", 'format = "ulna-study/1"\n', "another kind of file"),
        ("head", 'format = "ulna-verify/1"\nunits = { length = "mm", angle = "rad" }\n', "key 'profile' is missing"),
        ("head", 'format = "ulna-verify/1"\nprofile = "iso-10360-12"\n', "units are never guessed"),
        ("keys", "bal = 6.0\n", "unknown key 'bal'. Did you mean 'ball'?"),
        ("keys", "", "State ball = … in"),
        ("mpe", "[mpe]\nP_Sise = 0.01\n", "key 'mpe.P_Sise': no test of profile 'iso-10360-12' gives it. Did you mean"),
        ("mpe", "[mpe]\nP_Size = -0.01\n", "expected a number greater than 0"),
        ("mpe", "[mpe]\nE_Uni = { a = 0.01 }\n", "key 'mpe.E_Uni.b' is missing"),
        ("ball", '[artefact.ball]\nkind = "bal"\n', "got 'bal', expected ball or length"),
        ("ball", "", "column 'artefact': got 'ball', which"),
        ("ball", BALL.replace("u = 0.0003\n", ""), "key 'artefact.ball.u' is missing"),
        ("bar", BALL.replace("ball]", "bar]"), "artefact 'bar' is of kind 'ball', expected a length"),
        (
            "bar",
            '[artefact.bar]\nkind = "length"\nlength = 600.0\nu = 0.001\nends = "opposite-faces"\n',
            "of direction 'uni', but artefact 'bar' has ends = \"opposite-faces\"",
        ),
        ("readings", '[[readings]]\nfile = "gone.csv"\n', "no such file"),
        ("readings", '[[readings]]\nfile = "touches.csv"\nstate = "before"\n', "expected 'as-found' or 'as-left'"),
        ("readings", '[[readings]]\nfile = "touches.csv"\nangle = "deg"\n', "expected it with encoder readings only"),
    ],
)
def test_bad_keys(tmp_path: Path, part: str, text: str, expected: str) -> None:
    assert expected in told(write_plan(tmp_path, **{part: text}))


def test_bad_profile(tmp_path: Path) -> None:
    head = 'format = "ulna-verify/1"\nprofile = "iso-10360-21"\nunits = { length = "mm", angle = "rad" }\n'
    assert "Did you mean 'iso-10360-12'?" in told(write_plan(tmp_path, head=head))


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (lambda t: t.drop("z"), "the column 'z' is missing"),
        (lambda t: t.rename({"position": "positon"}), "unknown column 'positon'. Did you mean 'position'?"),
        (lambda t: t.with_columns(pl.lit("probng").alias("test")), "row 1, column 'test': got 'probng'"),
        (lambda t: t.drop("test"), "which test it belongs to is not said"),
        (lambda t: t[:3], "test 'probing', ball ball, position 1: 3 points; expected 4 at the least"),
        (lambda t: t.filter(pl.col("feature") != "B"), "only end A was touched (1 rows); a length needs A and B"),
        (lambda t: t.with_columns(pl.col("feature").replace("A", "left")), "got 'left'; expected A or B"),
        (lambda t: t.with_columns(pl.lit("1").alias("orientation")), "all 25 points are of one orientation"),
        (lambda t: t[:50].with_columns(pl.lit(1.0).alias("z")), "points are on a plane"),
        (lambda t: t.with_columns(pl.lit("x").alias("y")), "column 'y': got 'x', expected a number"),
        (lambda t: t[:0], "there are no rows"),
        (lambda t: t.with_columns(pl.lit(0.1).alias("q1")), "are encoder readings, but no arm is named"),
    ],
)
def test_bad_tables(tmp_path: Path, change, expected: str) -> None:  # type: ignore[no-untyped-def]
    assert expected in told(write_plan(tmp_path, change(iso_rows())))


def test_encoders_and_coordinates_in_one_file(tmp_path: Path) -> None:
    platinum().save(tmp_path / "arm.toml")
    table = iso_rows().with_columns(pl.lit(0.1).alias(f"q{k}") for k in range(1, 8))
    assert "and coordinates as well" in told(write_plan(tmp_path, table), tmp_path / "arm.toml")


def test_an_arm_without_use_is_remarked_upon(tmp_path: Path) -> None:
    platinum().save(tmp_path / "arm.toml")
    with pytest.warns(UserWarning, match="the arm is not used: its readings are coordinates"):
        ulna.verify(write_plan(tmp_path), tmp_path / "arm.toml")


def profile(folder: Path, text: str) -> Path:
    (folder / "own.toml").write_text('format = "ulna-profile/1"\nname = "own"\n' + text, encoding="utf-8")
    head = 'format = "ulna-verify/1"\nprofile = "own.toml"\nunits = { length = "mm", angle = "rad" }\n'
    return write_plan(folder, head=head)


def test_a_profile_of_ones_own(tmp_path: Path) -> None:
    text = (
        'based_on = "iso-10360-12"\nwithout = ["bi"]\nunit = "mm"\n[decision]\nrule = "simple"\n'
        "[limit]\nP_Form = 1e-9\n"
        "[test.uni]\nlengths = 1\npositions = 2\nrepeats = 1\nlongest_share = 0.5\n"
    )
    found = ulna.verify(profile(tmp_path, text))
    assert found.plan.profile.file.test.keys() == {"probing", "articulation", "uni"}
    assert [test.departures for test in found.states[0].tests] == [[], [], []]
    assert found.states[0].departures == []
    assert found.rule.guard_mm(1.0) == 0.0
    assert found.plan.profile.file.standard.startswith("ISO 10360-12")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            'based_on = "iso-10360-12"\nwithout = ["by"]\n',
            "got 'by', no test of 'iso-10360-12'. Known: prob",
        ),
        ('based_on = "own.toml"\n', "based on each other in a circle"),
        ('based_on = "iso-10360-12"\n[limit]\nP_Form = 0.1\n', "key 'unit' is missing, but there are limits"),
        ('based_on = "iso-10360-12"\n[test.uni]\nkind = "lenght"\n', "got 'lenght', expected sphere"),
        ('based_on = "iso-10360-12"\n[test.uni]\nposition = 3\n', "unknown key 'test.uni.position'"),
        ('standard = "x"\n', "key 'statement' is missing"),
    ],
)
def test_bad_profiles(tmp_path: Path, text: str, expected: str) -> None:
    assert expected in told(profile(tmp_path, text))


def test_the_command_line(tmp_path: Path) -> None:
    path = write_plan(tmp_path)
    assert_bad_input(run("verify"), "got 0 files; expected ARM PLAN")
    assert_bad_input(run("verify", path, "--play", path), "there is nothing to play")
    assert_bad_input(run("verify", "--make-plan", "iso-10360-12"), "expected -o DIR")
    assert_bad_input(run("verify", path, "-o", path), "this is a file; expected an output folder")
    done = run("verify", path, "-o", tmp_path / "out")
    assert done.returncode == 1, "P_Size fails"
    assert "FAIL" in done.stdout
    assert "A value fails (as-left)" in done.stderr
    assert max(len(line.rstrip()) for line in done.stdout.splitlines()) <= 80
    assert "L_Dia.5x5:Art:Tact.AArm" in done.stdout, "no ':Art:' as a picture"
    assert_bad_input(run("verify", path, "-o", tmp_path / "out"), "exists already and is not overwritten")
