"""Where artefacts stood comes out of a calibration, and the stated uncertainties hold the truth."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.simulations import BAR, PLATE, saved, write

import ulna

SEAT = '[artefact.cone]\nkind = "seat"\nplacements = 6\ntouches = 6\n'
NOISE = "noise = { encoder = 2e-5, seat = 0.02 }\n"


@pytest.mark.parametrize("stated", [True, False], ids=["noise stated", "noise from the scatter"])
def test_standings_are_where_they_were(tmp_path: Path, stated: bool) -> None:
    """Over seeds: errors over stated uncertainties scatter by one, each coordinate and each turn."""
    origins, turns, lines = [], [], []
    for seed in range(6):
        text = BAR.replace("u = 0.001", "u = 0.0") + "placements = 12\n"
        text += PLATE.replace("u = 0.001", "u = 0.0") + "placements = 8\n" + SEAT
        simulated, study = saved(write(tmp_path / str(seed), text, f"{NOISE}seed = {seed}\n"))
        # the base frame is that of the first axis: as the truth has it, so that both speak of the same one
        study = replace(study, arm=simulated.truth.arm, noise=study.noise if stated else None)
        result = ulna.calibrate(study)
        true = {(entry["artefact"], entry["placement"]): entry for entry in simulated.as_dict()["placements"]}
        assert len(result.placements) == len(true) == 26
        for pose in result.placements:
            truth = true[pose.artefact, pose.placement]
            assert pose.u_origin_mm is not None
            off_mm = np.array(pose.origin_mm) - truth["origin_mm"]
            origins.append(off_mm / pose.u_origin_mm)
            assert (pose.axes is None) == (pose.artefact != "plate")
            if pose.axes is not None:
                assert pose.u_turn_rad is not None
                turned = np.array(pose.axes).T @ np.array(truth["axes"])
                turns.append(np.array([turned[2, 1], turned[0, 2], turned[1, 0]]) / pose.u_turn_rad)
            if pose.direction is not None:
                assert pose.u_turn_rad is not None
                lines.append(np.linalg.norm(np.cross(pose.direction, truth["axes"][0])) / pose.u_turn_rad)
    scatter = float(np.mean(np.square(origins)))
    assert 0.7 < scatter < 1.35, scatter
    # the largest of the uncertainties about any axis is stated: no turn errs by more, most by less
    assert 0.15 < float(np.mean(np.square(turns))) < 1.3
    assert float(np.mean(np.square(lines))) < 2.6


def test_they_are_in_the_file(tmp_path: Path) -> None:
    _, study = saved(write(tmp_path, PLATE + "placements = 6\n" + SEAT))
    result = ulna.calibrate(study)
    result.save(tmp_path / "result")
    assert ulna.Result.load(tmp_path / "result").placements == result.placements
    assert [pose.artefact for pose in result.placements] == ["plate"] * 6 + ["cone"] * 6
    cone = result.placements[-1]
    assert (cone.axes, cone.direction, cone.u_turn_rad) == (None, None, None)
