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
#: the same after a knock, as checks before work find it
KNOCKED = ulna.Arm.load(HERE / "knocked.toml")
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


def morning(arm: ulna.Arm, rng: np.random.Generator) -> pl.DataFrame:
    """A check of three minutes: a cone touched eight times, elbow and wrist moved, and a bar in three places."""
    ends = {
        "front": ([500.0, -200.0, 150.0], [0.0, 1.0, 0.0]),
        "left": ([150.0, 550.0, 50.0], [1.0, 0.0, 0.0]),
        "upright": ([600.0, 150.0, -100.0], [0.0, 0.0, 1.0]),
    }
    points = [np.array([450.0, 250.0, 100.0])] * 8
    labels = [("seat", "", "")] * 8
    for place, (first, direction) in ends.items():
        points += [np.array(first), np.array(first) + BAR_MM * np.array(direction)]
        labels += [("bar", place, "A"), ("bar", place, "B")]
    beside_mm = np.stack(points) + rng.normal(0.0, SEAT_NOISE_MM, (len(points), 3))
    q_rad, reached = arm.core.pose_for_points(beside_mm, LIMITS_RAD, int(rng.integers(2**31)), arm.probe_index("bent"))
    assert reached.all(), "a place of the check is out of reach"
    test, position, feature = map(list, zip(*labels, strict=True))
    read = q_rad + rng.normal(0.0, ENCODER_NOISE_RAD, q_rad.shape)
    return table(read, test=test, position=position, feature=feature)


def mornings() -> dict[str, pl.DataFrame]:
    """File name → readings of eight checks; before the last one the arm was knocked."""
    rng = np.random.default_rng(20261130)
    days = [2, 4, 6, 9, 11, 13, 16, 18]
    return {f"morning-11-{day:02d}.csv": morning(KNOCKED if day == days[-1] else TRUTH, rng) for day in days}


def generate() -> dict[str, pl.DataFrame]:
    """File name → readings."""
    rng = np.random.default_rng(20110541)
    return {
        "bars.csv": bars(101, "bent", rng),
        "check-bars.csv": (check := bars(10, "bent", rng)),
        "length.csv": check.head(2),
        "seat.csv": seat(32, "straight", rng),
        "check-straight.csv": bars(10, "straight", rng),
        **mornings(),
    }


if __name__ == "__main__":
    for name, readings in generate().items():
        readings.write_csv(HERE / name)
        print(f"{name}: {len(readings)} rows")
