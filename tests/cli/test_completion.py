"""The tab key, in a real shell where there is one."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import typer.main
from tests.cli_runs import assert_bad_input, run

from ulna.cli import app
from ulna.cli.commands import COMMANDS, GROUPS
from ulna.cli.completing import SHELLS
from ulna.cli.demos import DEMOS
from ulna.reproduce import STUDIES

bash = pytest.mark.skipif(shutil.which("bash") is None or sys.platform == "win32", reason="no bash")

#: as bash does it when the key is pressed: the function that `complete` names, with the words so far
PRESS = """
eval "$(ulna completion bash)"
name=$(complete -p ulna | sed 's/.*-F \\([^ ]*\\).*/\\1/')
COMP_WORDS=(%s)
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
$name ulna
printf '%%s\\n' "${COMPREPLY[@]}"
"""


@pytest.fixture(scope="module")
def door(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the command `ulna` of this very Python."""
    folder = tmp_path_factory.mktemp("bin")
    (folder / "ulna").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m ulna "$@"\n')
    (folder / "ulna").chmod(0o755)
    return folder


def pressed(door: Path, words: str) -> list[str]:
    """What bash offers after these words, the last of which is being typed."""
    done = subprocess.run(
        ["bash", "--norc", "-c", PRESS % words],
        capture_output=True,
        text=True,
        timeout=60,
        env=os.environ | {"PATH": f"{door}{os.pathsep}{os.environ['PATH']}"},
        check=True,
    )
    assert done.stderr == ""
    return done.stdout.split()


@bash
def test_bash_completes_commands_options_names_and_files(door: Path) -> None:
    assert pressed(door, "ulna cal") == ["calibrate"]
    assert pressed(door, 'ulna ""') == [*COMMANDS, *GROUPS]
    assert set(pressed(door, "ulna calibrate --")) == {
        "--out",
        "--force",
        "--json",
        "--all",
        "--judge",
        "--record",
        "--help",
    }
    assert pressed(door, 'ulna import ""') == ["mukca", "ipa-ur10", "serial-robots", "urdf", "dh"]
    assert pressed(door, "ulna import dh --conv") == ["--convention"]
    assert pressed(door, 'ulna reproduce ""') == list(STUDIES)
    assert pressed(door, 'ulna demo ""') == list(DEMOS)
    assert pressed(door, 'ulna report result.json --language ""') == ["en", "de", "zh"]
    assert pressed(door, "ulna calibrate st") == []  # nothing of ours: bash then completes files, as it was told


@bash
def test_bash_is_told_to_complete_files_itself(door: Path) -> None:
    script = run("completion", "bash").stdout
    assert "complete -o default -F" in script


def test_no_option_of_any_command_is_forgotten(door: Path) -> None:
    """Each command's options as the shell gets them, beside those that the command takes."""
    root = typer.main.get_command(app)
    for name in COMMANDS:
        command = root.commands[name]
        known = {word for each in command.params for word in (*each.opts, *each.secondary_opts) if word[:2] == "--"}
        done = run(_ULNA_COMPLETE="complete_bash", COMP_WORDS=f"ulna {name} --", COMP_CWORD="2")
        assert set(done.stdout.split()) == known | {"--help"}, name


@pytest.mark.parametrize("shell", SHELLS)
def test_there_is_a_script_for_each_shell(shell: str) -> None:
    done = run("completion", shell)
    assert done.returncode == 0
    assert "_ULNA_COMPLETE" in done.stdout
    assert done.stderr == ""


@bash
def test_install_writes_where_the_shell_looks(tmp_path: Path) -> None:
    done = run("completion", "bash", "--install", HOME=str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / ".bash_completions" / "ulna.sh").is_file()
    assert "ulna.sh" in (tmp_path / ".bashrc").read_text()
    assert subprocess.run(["bash", "-n", tmp_path / ".bashrc"], check=False).returncode == 0


def test_an_unknown_shell_is_told() -> None:
    assert_bad_input(run("completion", "bsh"), "got 'bsh'; expected bash, zsh, fish, powershell or pwsh", "'bash'")
