"""A study of very many bars, made in seconds: what no arm will ever touch, to see what a run costs a reading."""

from pathlib import Path

import numpy as np
import polars as pl

from benchmarks.lengths import F64
from ulna.arm.arm import Arm

PLATINUM = Path(__file__).resolve().parents[1] / "examples" / "platinum"
BAR_MM = 443.172
ENCODER_NOISE_RAD = 5e-6

STUDY = f"""format = "ulna-study/1"
arm = "{(PLATINUM / "platinum.toml").as_posix()}"
units = {{ length = "mm", angle = "rad" }}
readings = [{{ file = "bars.parquet", artefact = "bar", probe = "bent" }}]
artefact = {{ bar = {{ kind = "bar", length = {BAR_MM} }} }}
noise = {{ encoder = {ENCODER_NOISE_RAD} }}
fit = {{ hold = ["joint.1.theta0", "joint.1.d"] }}
"""


def both_ends(truth: Arm, bars: int, rng: np.random.Generator) -> F64:
    """(bars, 2, 7) encoder angles, rad, of an arm that touches both ends of so many standings of the bar.

    Two random poses each; then the first joint of the second is turned until the tips are as far apart as the bar is
    long, where it can be: distance² = r² + s² - 2 r s cos(turn) + Δz² of the tips' cylindrical coordinates.
    """
    found: list[F64] = []
    while sum(map(len, found)) < bars:
        q_rad = rng.uniform(-2.5, 2.5, (2 * bars, 2, truth.n))
        tip_mm = truth.tip(q_rad.reshape(-1, truth.n), "bent").reshape(-1, 2, 3)
        radius = np.hypot(tip_mm[..., 0], tip_mm[..., 1])
        at = np.arctan2(tip_mm[..., 1], tip_mm[..., 0])
        apart2 = (radius**2).sum(axis=1) + np.diff(tip_mm[..., 2], axis=1)[:, 0] ** 2 - BAR_MM**2
        cosine = apart2 / (2.0 * radius.prod(axis=1))
        there = np.abs(cosine) <= 1.0
        turn = np.arccos(cosine[there]) - (at[there, 1] - at[there, 0])
        q_rad = q_rad[there]
        q_rad[:, 1, 0] += truth.signs[0] * turn
        q_rad[:, 1, 0] = (q_rad[:, 1, 0] + np.pi) % (2.0 * np.pi) - np.pi
        found.append(q_rad)
    return np.concatenate(found)[:bars]


def write(folder: Path, bars: int, seed: int = 1) -> Path:
    """The study file of so many standings, each touched once at both ends, with readings in Parquet."""
    rng = np.random.default_rng(seed)
    q_rad = both_ends(Arm.load(PLATINUM / "truth.toml"), bars, rng).reshape(2 * bars, -1)
    q_rad += rng.normal(0.0, ENCODER_NOISE_RAD, q_rad.shape)
    table = pl.DataFrame({f"q{k + 1}": column for k, column in enumerate(q_rad.T)}).with_columns(
        placement=pl.format("place {}", pl.int_range(2 * bars) // 2 + 1),
        feature=pl.when(pl.int_range(2 * bars) % 2 == 0).then(pl.lit("A")).otherwise(pl.lit("B")),
    )
    folder.mkdir(parents=True, exist_ok=True)
    table.write_parquet(folder / "bars.parquet")
    study = folder / "study.toml"
    study.write_text(STUDY, encoding="utf-8")
    return study
