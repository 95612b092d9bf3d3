"""Makes the readings beside this file: a virtual arm touches a bar and a cone, with noise, from a fixed seed.

The arm is the real FARO Platinum of Cheng, Yu, Fei (2011), Table 4: its published numbers are the truth that the
readings come from. Run it with `make example-data`; a test tells when the committed files are not what it makes.
"""

from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray

import ulna

F64 = NDArray[np.float64]

HERE = Path(__file__).resolve().parent
BAR_MM = 443.172
ENCODER_NOISE_RAD = 5e-6
SEAT_NOISE_MM = 0.008
#: the travel of every joint of the virtual arm
TRAVEL_RAD = 3.0
#: bent: Table 4. straight: what the paper found for its second probe
PROBES = {
    "bent": ulna.Probe.from_cylindrical(0.431148, 39.4321, 223.8773),
    "straight": ulna.Probe.from_cylindrical(-1.8676, 0.0965, 238.5596),
}
TRUTH = ulna.Arm("Table 4", ulna.Arm.load(HERE / "platinum-straight.toml").joints, PROBES)
LIMITS_RAD = np.tile([-TRAVEL_RAD, TRAVEL_RAD], (TRUTH.n, 1))


def points_in_reach(count: int, probe: str, rng: np.random.Generator) -> F64:
    """(count, 3) mm: where the tip of a random pose is, not too near the column and not at full stretch."""
    poses_rad = rng.uniform(-TRAVEL_RAD, TRAVEL_RAD, (20 * count, TRUTH.n))
    points_mm = TRUTH.tip(poses_rad, probe)
    distance_mm = np.linalg.norm(points_mm, axis=1)
    usable: F64 = points_mm[(distance_mm > 300.0) & (distance_mm < 1000.0)]
    return usable[:count]


def touch(points_mm: F64, probe: str, rng: np.random.Generator) -> tuple[F64, NDArray[np.bool_]]:
    """Encoder readings (N, 7) of touching points (N, 3) with a random elbow and wrist, and whether each is in reach."""
    beside_mm = points_mm + rng.normal(0.0, SEAT_NOISE_MM, points_mm.shape)
    seed = int(rng.integers(2**31))
    q_rad, reached = TRUTH.core.pose_for_points(beside_mm, LIMITS_RAD, seed, TRUTH.probe_index(probe))
    return q_rad + rng.normal(0.0, ENCODER_NOISE_RAD, q_rad.shape), reached


def table(q_rad: F64, **columns: list[str]) -> pl.DataFrame:
    """Label columns, then q1 … q7, to 1e-10 rad: far below the noise, and short to read."""
    angles = {f"q{i + 1}": np.round(q_rad[:, i], 10) for i in range(q_rad.shape[1])}
    return pl.DataFrame({**columns, **angles})


def bars(count: int, probe: str, rng: np.random.Generator) -> pl.DataFrame:
    """A bar in `count` places and directions, each seat touched once."""
    first_mm = points_in_reach(4 * count, probe, rng)
    direction = rng.normal(size=first_mm.shape)
    second_mm = first_mm + BAR_MM * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    q_first, reached_first = touch(first_mm, probe, rng)
    q_second, reached_second = touch(second_mm, probe, rng)
    usable = np.flatnonzero(reached_first & reached_second)[:count]
    assert len(usable) == count, "too few bars in reach: draw more points"
    q_rad = np.stack([q_first[usable], q_second[usable]], axis=1).reshape(2 * count, TRUTH.n)
    placement = [f"place {k // 2 + 1}" for k in range(2 * count)]
    return table(q_rad, placement=placement, feature=["A", "B"] * count)


def seat(poses: int, probe: str, rng: np.random.Generator) -> pl.DataFrame:
    """One cone in front of the arm, touched from many sides."""
    place_mm = np.array([450.0, 250.0, 100.0])
    q_rad, reached = touch(np.tile(place_mm, (poses, 1)), probe, rng)
    assert reached.all(), "the cone is out of reach"
    return table(q_rad)


def generate() -> dict[str, pl.DataFrame]:
    """File name → readings."""
    rng = np.random.default_rng(20110541)
    return {
        "bars.csv": bars(101, "bent", rng),
        "check-bars.csv": (check := bars(10, "bent", rng)),
        "length.csv": check.head(2),
        "seat.csv": seat(32, "straight", rng),
        "check-straight.csv": bars(10, "straight", rng),
    }


if __name__ == "__main__":
    for name, readings in generate().items():
        readings.write_csv(HERE / name)
        print(f"{name}: {len(readings)} rows")
