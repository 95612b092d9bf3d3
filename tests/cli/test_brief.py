"""What a calibration prints fits one screen; of a fit that ended badly, half of one; all of it with --all."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import run
from tests.simulations import BAR, NOISE, PLATE, saved, with_effects, write

import ulna
from ulna import Study


def lines_of(width: int, *arguments: str) -> tuple[int, list[str]]:
    done = run(*arguments, COLUMNS=str(width))
    return done.returncode, [*done.stdout.splitlines(), *done.stderr.splitlines()]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An arm with harmonics, expansion and compliance: more parameters than a screen has lines."""
    folder = tmp_path_factory.mktemp("brief")
    extras = 'fit = { extras = ["encoder-harmonics", "link-expansion", "compliance"], judge_extras = false }'
    more = f"{NOISE}\ntemperature = {{ mean = 22.0, spread = 4.0 }}\n{extras}\n"
    saved(write(folder, BAR + "placements = 120\n" + PLATE + "placements = 10\n", more, with_effects()))
    return folder / "out"


@pytest.mark.parametrize("width", [60, 80])
def test_a_fit_that_ended_well_fits_a_screen(folder: Path, width: int) -> None:
    code, lines = lines_of(width, "calibrate", str(folder / "study.toml"))
    assert code == 0
    assert len(lines) <= 60
    assert max(map(len, lines)) <= width
    assert any(line.startswith("Converged: ") and "parameters determined" in line for line in lines[-4:])
    assert any("more: --all shows them." in line for line in lines)
    _, every = lines_of(width, "calibrate", str(folder / "study.toml"), "--all")
    result = ulna.calibrate(Study.load(folder / "study.toml"))
    assert len(every) > 60
    assert all(any(line.startswith(f"{row.name} ") for line in every) for row in result.parameters)


@pytest.mark.parametrize("width", [60, 80])
def test_one_that_did_not_says_what_is_worst_and_what_to_try(tmp_path: Path, width: int) -> None:
    simulated, study = saved(write(tmp_path, PLATE + "placements = 10\n"))
    shown = replace(study, arm=simulated.truth.arm)
    shown.arm.save(tmp_path / "out" / "arm.toml", force=True)
    text = (tmp_path / "out" / "study.toml").read_text()
    (tmp_path / "out" / "study.toml").write_text(text.replace("[fit]", '[fit]\nhold = ["joint.*"]', 1))
    table = tmp_path / "out" / "plate.csv"
    head, *rows = table.read_text().splitlines()
    two, four = head.split(",").index("q2"), head.split(",").index("q4")

    def swapped(row: str) -> str:
        cells = row.split(",")
        cells[two], cells[four] = cells[four], cells[two]
        return ",".join(cells)

    table.write_text("\n".join([head, *map(swapped, rows)]) + "\n")
    code, lines = lines_of(width, "calibrate", str(tmp_path / "out" / "study.toml"))
    text = " ".join(line.strip() for line in lines)
    assert code == 1
    assert len(lines) <= 25
    assert "readings of joints 2 and 4 are swapped" in text
    assert "Worst met" in text
    assert "do not use these numbers" in text
    # nothing that only holds of an arm that was found
    for word in ("standard uncertainty", "determine", "Before and after", "fitted"):
        assert word not in text, word


def test_with_a_loss_the_figures_without_what_is_far_off_stand_beside(tmp_path: Path) -> None:
    _, study = saved(write(tmp_path, BAR + "placements = 60\n"))
    group = study.readings[0]
    q_rad = group.q_rad.copy()
    q_rad[[3, 40, 77], 1] += 0.01
    spoiled = replace(study, readings=[replace(group, q_rad=q_rad)], fit=replace(study.fit, loss="tukey"))
    result = ulna.calibrate(spoiled)
    assert result.without_far_off is not None
    kept = np.setdiff1d(np.arange(len(group)), [3, 40, 77])
    clean = ulna.calibrate(replace(spoiled, readings=[replace(group, q_rad=q_rad).select(kept)]))
    name = "length_error_rms_mm"
    assert result.after[name] > 10.0 * result.without_far_off[name]
    assert result.without_far_off[name] == pytest.approx(clean.after[name], rel=0.2)
    result.save(tmp_path / "result")
    assert ulna.Result.load(tmp_path / "result").without_far_off == result.without_far_off
