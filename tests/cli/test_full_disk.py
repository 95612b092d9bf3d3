"""No room, no right to write, no such place: every command that writes says so, and nothing half written stays."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="POSIX limits")

#: the words of each command that writes; {out} is the place, a folder or a file
COMMANDS = {
    "new": "new --readings bars.csv --artefact bar --length 443.172 --arm platinum.toml --zeros known --signs known "
    "--length-unit mm --angle-unit rad -o {out}",
    "show": "show platinum.toml -o {out}.html",
    "calibrate": "calibrate study.toml -o {out}",
    "evaluate": "evaluate done check.toml -o {out}",
    "measure csv": "measure done bars.csv -o {out}.csv",
    "measure parquet": "measure done bars.csv -o {out}.parquet",
    "measure xlsx": "measure done bars.csv -o {out}.xlsx",
    "measure lines": "measure done bars.csv -o {out}.jsonl",
    "uncertainty": "uncertainty done volume.toml -o {out}",
    "certificate": "certificate done laboratory.toml -o {out}.xml",
    "certificate pdf": "report done --lab laboratory.toml -o {out}.pdf",
    "batch": "batch arms -o {out}",
    "simulate": "simulate simulation.toml -o {out}",
    "plan": "plan platinum.toml plan.toml -o {out}",
    "report": "report done -o {out}.html",
    "verify": "verify --make-plan iso-10360-12 -o {out}",
    "import dh": "import dh arm.csv --convention dh -o {out}.toml",
    "import urdf": "import urdf arm.urdf -o {out}.toml",
    "export urdf": "export urdf done -o {out}.urdf",
    "export dh": "export dh done -o {out}.csv",
    "live measure": "live measure done rest.toml --still -o {out}.csv",
    "live commission": "live commission virtual:?poses=poses.csv&speed=max&rate=100&hand=4 --joints 7 --yes "
    "--signs unknown -o {out}",
}

#: a process in which the commands run one after the other, under a limit for the size of files or none
DOOR = """
import contextlib, io, json, resource, sys
from ulna.__main__ import main
limit = json.loads(sys.argv[1])
said = {}
for name, words in json.load(sys.stdin).items():
    heard, code = io.StringIO(), 0
    if limit:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    sys.argv = ["ulna", *words]
    try:
        with contextlib.redirect_stderr(heard), contextlib.redirect_stdout(io.StringIO()):
            main()
    except SystemExit as end:
        code = end.code or 0
    resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    said[name] = [code, heard.getvalue()]
print(json.dumps(said))
"""

SIMULATION = """
format = "ulna-simulation/1"
arm = "platinum.toml"
units = { length = "mm", angle = "rad" }
travel = { limits = [[-2.5, 2.5]] }
[artefact.bar]
kind = "bar"
placements = 30
length = 443.172
"""

#: a hand that rests
REST = """
format = "ulna-source/1"
url = "file:rest.csv?speed=max"
[map]
unit = "rad"
"""


def run_all(folder: Path, out: str, limit: int = 0) -> dict[str, tuple[int, str]]:
    """Of each command its exit code and what it said on stderr."""
    words = {name: command.format(out=f"{out}-{name.replace(' ', '-')}").split() for name, command in COMMANDS.items()}
    done = subprocess.run(
        [sys.executable, "-c", DOOR, json.dumps(limit)],
        input=json.dumps(words),
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=600,
        env=os.environ | {"COLUMNS": "300", "TERM": "dumb"},
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return {name: (code, text) for name, (code, text) in json.loads(done.stdout).items()}


def one_after_the_other(joints: int) -> str:
    """Postures of an arm that is held still, then turned joint by joint."""
    rows = [[0.0] * joints] * 5
    for k in range(joints):
        rows += [[angle * (j == k) for j in range(joints)] for angle in (-1.2, 1.1, 0.0, 0.0, 0.0)]
    return "\n".join([",".join(f"q{k + 1}" for k in range(joints)), *(",".join(map(str, row)) for row in rows)]) + "\n"


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory, root: Path) -> Path:
    """A folder in which every command has what it reads."""
    folder = tmp_path_factory.mktemp("bench")
    for path in (root / "examples" / "platinum").iterdir():
        shutil.copy(path, folder) if path.is_file() else None
    shutil.copytree(folder, folder / "arms" / "one", ignore=lambda _, names: {n for n in names if "check" in n})
    for study in (folder / "arms" / "one").glob("*.toml"):
        if study.name not in ("study.toml", "platinum.toml"):
            study.unlink()
    (folder / "simulation.toml").write_text(SIMULATION)
    (folder / "rest.toml").write_text(REST)
    (folder / "rest.csv").write_text("q1,q2,q3,q4,q5,q6,q7\n" + 500 * "0.1,0.2,0.3,0.4,0.5,0.6,0.7\n")
    (folder / "poses.csv").write_text(one_after_the_other(7))
    prepared = [
        "calibrate study.toml -o done",
        "export urdf platinum.toml -o arm.urdf",
        "export dh platinum.toml -o arm.csv",
    ]
    for words in prepared:
        subprocess.run([sys.executable, "-m", "ulna", *words.split()], cwd=folder, capture_output=True, check=True)
    return folder


def listing(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}


def test_no_room_is_told_by_every_command(bench: Path) -> None:
    before = listing(bench)
    for name, (code, said) in run_all(bench, "out", limit=100).items():
        assert code == 2, (name, said)
        assert "error: " in said, (name, said)
        assert "cannot be written (File too large)" in said, (name, said)
        assert "Traceback" not in said, (name, said)
    assert listing(bench) == before


def test_a_place_that_is_none_is_told_by_every_command(bench: Path) -> None:
    """A file where the folder should be; nobody, not even root, may write there."""
    (bench / "file").write_text("mine")
    before = listing(bench)
    for name, (code, said) in run_all(bench, "file/out").items():
        assert code == 2, (name, said)
        assert "error: file" in said, (name, said)
        assert "Traceback" not in said, (name, said)
    assert listing(bench) == before
    assert (bench / "file").read_text() == "mine"


#: a disk of its own: its options, what else is done to it, what every command says
DISKS = {
    "full": ("size=64k", "fill", "No space left on device"),
    "no more files": ("nr_inodes=1", "", "No space left on device"),
    "read-only": ("size=64k", "remount", "Read-only file system"),
}


@pytest.fixture(params=DISKS)
def disk(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[tuple[Path, str]]:
    """A real one, and its reason."""
    options, then, reason = DISKS[request.param]
    place = tmp_path / "disk"
    place.mkdir()
    if sys.platform != "linux" or _mount("-t", "tmpfs", "-o", options, "tmpfs", str(place)):
        pytest.skip("a disk may not be mounted here")  # not everywhere that CI runs, so no real part
    try:
        if then == "fill":
            with (place / "others").open("wb", buffering=0) as file, suppress(OSError):
                while True:
                    file.write(bytes(4096))
        if then == "remount":
            assert not _mount("-o", "remount,ro", str(place))
        yield place, reason
    finally:
        subprocess.run(["umount", str(place)], check=True)


def _mount(*words: str) -> int:
    return subprocess.run(["mount", *words], capture_output=True, check=False).returncode


@pytest.mark.long
@pytest.mark.skipif(shutil.which("mount") is None, reason="no mount")
def test_a_real_disk_that_takes_nothing_is_told_by_every_command(bench: Path, disk: tuple[Path, str]) -> None:
    place, reason = disk
    before, beside = listing(place), listing(bench)
    for name, (code, said) in run_all(bench, str(place / "out")).items():
        assert code == 2, (name, said)
        assert said.count("error: ") == 1, (name, said)
        assert f"cannot be written ({reason})" in said, (name, said)
        assert "Traceback" not in said, (name, said)
        assert listing(place) == before, name
    assert listing(bench) == beside
