"""`ulna demo`: what a newcomer types first."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from tests.cli_runs import assert_bad_input, run, strict_json

import ulna
from ulna.cli.demos import DEMOS, examples_folder


def played(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """The demo, run as a newcomer does: in a folder of their own, all output in one stream."""
    return subprocess.run(
        [sys.executable, "-m", "ulna", "demo", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
        cwd=folder,
        env=os.environ | {"COLUMNS": "80", "TERM": "dumb"},
        check=False,
    )


@pytest.mark.parametrize("name", DEMOS)
def test_each_example_plays_and_what_it_says_is_so(tmp_path: Path, name: str) -> None:
    done = played(tmp_path, name)
    assert done.returncode == 0, done.stdout
    lines = done.stdout.splitlines()
    for file, what in DEMOS[name].results:
        assert (tmp_path / "ulna-demo" / file).is_file(), file
        assert any(f"ulna-demo/{file}" in line and what in line for line in lines)
    for step in DEMOS[name].steps:
        assert f"$ ulna {step.command.replace('{}', 'ulna-demo')}" in lines
        for begins in step.shows:
            assert begins in done.stdout, f"{step.command} prints nothing that begins with {begins!r} any more"
    # what it says to try next works as it stands, but for the user's own table
    for command, _ in DEMOS[name].next:
        if "YOUR-TABLE" not in command:
            words = shlex.split(command.replace("{}", str(tmp_path / "ulna-demo")))
            assert run(*words).returncode == 0, command


@pytest.fixture(scope="module")
def bars(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, subprocess.CompletedProcess[str]]:
    """The first example, played once: its folder's parent, and what was printed."""
    folder = tmp_path_factory.mktemp("newcomer")
    return folder, played(folder)


Played = tuple[Path, subprocess.CompletedProcess[str]]


def test_the_first_screen_is_short_and_the_arm_comes_out(bars: Played) -> None:
    folder, done = bars
    lines = done.stdout.splitlines()
    assert len(lines) <= 40
    assert all(len(line) <= 80 for line in lines if not line.startswith("Written: "))
    document = strict_json((folder / "ulna-demo" / "result" / "result.json").read_text())
    assert document["fit"]["converged"]
    before, after = (document["overall"][when]["length_error_rms_mm"] for when in ("before", "after"))
    assert after < 0.02 < 10.0 < before
    assert f"{after:.4f}" in done.stdout
    same = ulna.calibrate(ulna.Study.load(examples_folder() / "platinum" / "study.toml"))
    assert document["overall"]["after"]["length_error_rms_mm"] == same.after["length_error_rms_mm"]


def test_the_commands_shown_print_what_the_demo_shows(bars: Played) -> None:
    folder, done = bars
    step = DEMOS["bars"].steps[1]
    words = [str(folder / word.replace("{}", "ulna-demo")) if "{}" in word else word for word in step.command.split()]
    itself = "\n".join(line.rstrip() for line in run(*words).stdout.splitlines())
    paragraph = next(part for part in itself.split("\n\n") if part.startswith("Over all readings"))
    assert paragraph.strip() in done.stdout


def test_an_earlier_demo_is_kept_without_force(tmp_path: Path) -> None:
    mine = tmp_path / "ulna-demo" / "mine.txt"
    mine.parent.mkdir()
    mine.write_text("of the user")
    refused = played(tmp_path)
    assert refused.returncode == 2
    assert refused.stdout == "error: ulna-demo: is not empty. Name another folder with --into, or give --force.\n"
    assert [path.name for path in mine.parent.iterdir()] == ["mine.txt"]
    for _ in range(2):
        assert played(tmp_path, "--force").returncode == 0
    assert mine.read_text() == "of the user"


def test_into_another_folder_with_a_space(tmp_path: Path) -> None:
    done = played(tmp_path, "seat", "--into", "my demo")
    assert done.returncode == 0, done.stdout
    assert (tmp_path / "my demo" / "result" / "arm.toml").is_file()
    assert '$ ulna calibrate "my demo/seat.toml" -o "my demo/result"' in done.stdout.splitlines()


def test_list_and_unknown_names(tmp_path: Path) -> None:
    listed = run("demo", "--list")
    assert listed.returncode == 0
    assert [name for name in DEMOS if re.search(rf"^{name} ", listed.stdout, re.MULTILINE)] == list(DEMOS)
    assert_bad_input(run("demo", "bar", "--into", tmp_path / "x"), "Did you mean 'bars'?")
    assert not (tmp_path / "x").exists()


def test_every_file_of_an_example_is_copied_byte_for_byte(bars: Played) -> None:
    folder, _ = bars
    for file in DEMOS["bars"].files:
        copied = folder / "ulna-demo" / Path(file).name
        assert copied.read_bytes() == (examples_folder() / file).read_bytes()
