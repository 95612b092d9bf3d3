"""`ulna compare`: in words, in numbers, and by its exit code."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.cli_runs import BENT, assert_bad_input, platinum, run, strict_json, write_lengths

from ulna.arm.arm import Arm
from ulna.arm.joint import Joint


@pytest.fixture(scope="module")
def years(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two calibrations by the same readings, the bars of the second stated 0.3 mm longer each."""
    folder = tmp_path_factory.mktemp("years")
    for year, longer in (("2025", 0.0), ("2026", 0.3)):
        study = write_lengths(folder / year, noise="[noise]\nencoder = 5e-6\nseat = 0.01")
        table = (folder / year / "rows.csv").read_text().splitlines()
        place = table[0].split(",").index("length")
        rows = [line.split(",") for line in table[1:]]
        for row in rows:
            row[place] = repr(float(row[place]) + longer)
        (folder / year / "rows.csv").write_text("\n".join([table[0], *map(",".join, rows), ""]))
        assert run("calibrate", study, "-o", folder / f"out-{year}").returncode in (0, 1)
    return folder


def test_an_arm_that_has_not_moved(years: Path) -> None:
    done = run("compare", years / "out-2025", years / "out-2025")
    assert done.returncode == 0, done.stderr
    said = " ".join(done.stdout.split())
    assert "no more than both uncertainties explain (chi² 0.0 with" in said
    assert max(map(len, done.stdout.splitlines())) <= 80 or str(years) in done.stdout


def test_one_that_has(years: Path) -> None:
    done = run("compare", years / "out-2025", years / "out-2026", years / "out-2025", "--json")
    assert done.returncode == 1, done.stderr
    first, second = strict_json(done.stdout)["steps"]
    assert first["moved"]
    assert second["moved"]
    assert first["parameters"][0]["delta"] == pytest.approx(-second["parameters"][0]["delta"], rel=0.1)
    text = run("compare", years / "out-2025", years / "out-2026")
    assert "moved by more than both uncertainties explain" in " ".join(text.stdout.split())
    assert "mm longer, U =" in " ".join(text.stdout.split())
    assert "more: --all." in text.stdout
    assert "more: --all." not in run("compare", years / "out-2025", years / "out-2026", "--all").stdout


def test_what_cannot_be_compared_is_told(years: Path, tmp_path: Path) -> None:
    out = years / "out-2025"
    assert_bad_input(run("compare", out), "got 1 calibration; expected 2 to 6")
    assert_bad_input(run("compare", out, years / "2025" / "start.toml"), "start.toml", "without its calibration")
    assert_bad_input(run("compare", out, tmp_path / "none"), "none", "no such file")
    assert_bad_input(run("compare", out, out, "--shared-u", "2"), "shared u 2", "such as 2e-6")
    arm = platinum()
    Arm("six", (*arm.joints[:5], Joint()), {"bent": BENT}).save(tmp_path / "six.toml")
    assert_bad_input(run("compare", out, tmp_path / "six.toml"), "six.toml")
