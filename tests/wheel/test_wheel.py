"""The wheel, installed as somebody does who has no checkout: `make wheel-test` builds it and names it to the tests."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import openpyxl
import pytest

ROOT = Path(__file__).resolve().parents[2]
#: the wheel to test; without it these tests skip
NAMED = os.environ.get("ULNA_WHEEL", "")
BASE_MB = 450
"""How large an environment may be that holds Ulna, what it needs, and pip."""
WHEEL_MB = 6

pytestmark = [pytest.mark.skipif(not NAMED, reason="no wheel is named: make wheel-test"), pytest.mark.timeout(900)]

#: runs the program and says which files of the checkout it opened
WATCHED = f"""
import os, sys
sys.argv = ["ulna", *sys.argv[1:]]
seen = set()
def hear(event, given):
    if event == "open" and isinstance(given[0], (str, bytes)):
        seen.add(os.path.realpath(os.fsdecode(given[0])))
sys.addaudithook(hear)
from ulna.__main__ import main
try:
    main()
finally:
    print("OPENED", [path for path in seen if path.startswith({str(ROOT) + os.sep!r})], file=sys.stderr)
    print("FROM", sys.modules["ulna"].__file__, file=sys.stderr)
"""


@pytest.fixture(scope="module")
def held() -> zipfile.ZipFile:
    return zipfile.ZipFile(NAMED)


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A fresh environment with the wheel, dependencies in the versions of the lock; its Python."""
    folder = tmp_path_factory.mktemp("fresh")
    pins = re.findall(r"^[\w.-]+==\S+(?: ; [^\\\n]+)?", (ROOT / "requirements-dev.lock").read_text(), re.MULTILINE)
    (folder / "pins.txt").write_text("\n".join(pins) + "\n")
    venv.create(folder / "env", with_pip=True)
    python = folder / "env" / ("Scripts" if sys.platform == "win32" else "bin") / "python"
    command = [python, "-m", "pip", "install", "--quiet", "--constraint", folder / "pins.txt", Path(NAMED).resolve()]
    subprocess.run(command, check=True, env=alone(folder))
    return python


def alone(home: Path) -> dict[str, str]:
    """The environment without what could lead to the checkout."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL_ENV"))}
    return kept | {"HOME": str(home), "COLUMNS": "80", "TERM": "dumb", "PYTHONUTF8": "1"}


def ulna(python: Path, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """The installed program, run in a folder that is no checkout."""
    return subprocess.run(
        [python, "-I", "-c", WATCHED, *arguments],
        cwd=folder,
        env=alone(folder),
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def test_the_wheel_holds_the_examples_as_they_are(held: zipfile.ZipFile) -> None:
    there = {name for name in held.namelist() if name.startswith("ulna/examples/")}
    expected = {
        f"ulna/examples/{path.relative_to(ROOT / 'examples').as_posix()}": path
        for folder in ("platinum", "home-built")
        for path in (ROOT / "examples" / folder).iterdir()
        if path.suffix in {".toml", ".csv"}
    }
    assert there == set(expected)
    for name, path in expected.items():
        assert held.read(name) == path.read_bytes(), name


def test_the_wheel_holds_all_of_the_package_and_nothing_else(held: zipfile.ZipFile) -> None:
    package = ROOT / "python" / "ulna"
    ours = {
        f"ulna/{path.relative_to(package).as_posix()}"
        for path in package.rglob("*")
        if path.is_file() and path.suffix not in {".so", ".pyd", ".pyc"} and package / "examples" not in path.parents
    }
    names = {name for name in held.namelist() if not name.startswith(("ulna/examples/", "ulna-")) and name[-1] != "/"}
    (core,) = names - ours
    assert re.fullmatch(r"ulna/_core[\w.]*\.(so|pyd)", core)
    assert ours <= names
    assert "-abi3-" in Path(NAMED).name, "one wheel serves every Python from 3.11 on"
    assert Path(NAMED).stat().st_size < WHEEL_MB * 1e6


def test_the_environment_is_lean(installed: Path) -> None:
    size = sum(path.lstat().st_blocks * 512 for path in installed.parents[1].rglob("*"))
    assert size / 2**20 <= BASE_MB


def test_the_demo_works_from_the_wheel_alone(installed: Path, tmp_path: Path) -> None:
    done = ulna(installed, tmp_path, "demo")
    assert done.returncode == 0, done.stderr
    assert "OPENED []" in done.stderr
    assert str(installed.parents[1]) in done.stderr.split("FROM", 1)[1]
    assert (tmp_path / "ulna-demo" / "result" / "arm.toml").is_file()
    assert len(done.stdout.splitlines()) <= 40
    report = ulna(installed, tmp_path, "report", "ulna-demo/result", "-o", "report.html")
    assert report.returncode == 0, report.stderr
    assert "OPENED []" in report.stderr
    assert (tmp_path / "report.html").stat().st_size > 1e6


def test_a_workbook_is_read_without_any_extra(installed: Path, tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    rows = (ROOT / "examples" / "platinum" / "bars.csv").read_text().splitlines()
    for row in rows:
        book.active.append([float(cell) if re.fullmatch(r"[-+.\de]+", cell) else cell for cell in row.split(",")])
    book.save(tmp_path / "bars.xlsx")
    done = ulna(
        installed,
        tmp_path,
        *("new", "--readings", "bars.xlsx", "--artefact", "bar", "--length", "443.172", "--angle", "rad"),
        *("--reach", "1200", "--parallel", "none", "-o", "study"),
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "study" / "study.toml").is_file()


def test_what_needs_an_extra_says_so(installed: Path, tmp_path: Path) -> None:
    assert ulna(installed, tmp_path, "demo").returncode == 0
    done = ulna(installed, tmp_path, "report", "ulna-demo/result", "--pdf", "-o", "report.pdf")
    assert done.returncode == 2
    assert 'pip install "ulna[reports]"' in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "report.pdf").exists()


def test_every_command_has_its_help(installed: Path, tmp_path: Path) -> None:
    listed = ulna(installed, tmp_path, "--help").stdout.split("Commands", 1)[1]
    names = re.findall(r"^  ([a-z][\w-]*) ", listed, re.MULTILINE)
    assert len(names) > 15
    for name in names:
        done = ulna(installed, tmp_path, name, "--help")
        assert done.returncode == 0, done.stderr
        assert f"Usage: ulna {name}" in done.stdout
