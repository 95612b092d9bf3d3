"""What is not in an uncertainty is named: what nobody stated, what the model has not, what no interval can hold."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import platinum

import ulna
from ulna.arm.reading_noise import UNKNOWN, ReadingNoise
from ulna.uncertainties.left_out import left_out

ENCODERS = np.full(7, 5e-6)
NONE = "eccentric encoders: the arm's model has none"


def of(noise: ReadingNoise) -> list[str]:
    return left_out(platinum(), noise, 0.0, [])


def test_what_nobody_stated_is_named() -> None:
    said = " | ".join(of(UNKNOWN))
    assert "the encoders' noise while measuring: nobody stated it" in said
    assert "how well a touch finds its place" in said
    assert NONE in of(UNKNOWN)


def test_of_stated_noise_that_holds_only_the_model_is_named() -> None:
    said = of(ReadingNoise(ENCODERS, 0.008))
    assert not any("nobody" in each or "scatter" in each for each in said)
    assert NONE in said


@pytest.mark.parametrize(
    "noise", [ReadingNoise(None, 0.01, estimated=True), ReadingNoise(ENCODERS, 0.008, unexplained_mm=0.01)]
)
def test_of_a_scatter_that_was_seen_a_part_is_in(noise: ReadingNoise) -> None:
    said = of(noise)
    assert NONE not in said
    assert not any("nobody" in each for each in said)
    (absent,) = [each for each in said if "eccentric encoders" in each]
    assert "beyond what it added to the scatter of the calibration's touches" in absent
    assert any("changes over the volume" in each for each in said)


def test_of_a_form_it_is_said_that_noise_makes_it_larger(tmp_path: Path) -> None:
    examples = Path(__file__).resolve().parents[2] / "examples" / "platinum"
    result = ulna.calibrate(examples / "study.toml")
    rng = np.random.default_rng(3)
    angles = "\n".join(",".join(f"{angle:.6f}" for angle in row) for row in rng.uniform(0.2, 0.6, (5, 7)))
    (tmp_path / "touches.csv").write_text("q1,q2,q3,q4,q5,q6,q7\n" + angles)
    head = 'format = "ulna-task/1"\nunits = { length = "mm", angle = "rad" }\n'
    for kind, larger in (("flatness", True), ("plane", False)):
        (tmp_path / "task.toml").write_text(f'{head}kind = "{kind}"\n[readings]\nfile = "touches.csv"\nangle = "rad"\n')
        found = ulna.uncertainty(result, tmp_path / "task.toml", most_trials=0)
        assert any("noise makes a form larger" in each for each in found.left_out) == larger
