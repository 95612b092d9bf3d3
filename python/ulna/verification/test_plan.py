"""Making a plan: the verify file and the list of touches, empty to be measured, or played by a virtual arm."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import polars as pl

from ulna.arm.arm import Arm
from ulna.arm.given import ArmLike, as_arm
from ulna.formats.output import output_folder
from ulna.ground.arrays import Progress
from ulna.verification.plan_files import EMPTY, PLAN, TOUCHES, Filled, plan_toml, touches_table
from ulna.verification.player import play, range_of
from ulna.verification.profile import Profile, load_profile

FILES = (PLAN, TOUCHES)


@dataclass(frozen=True)
class TestPlan:
    """A verify file and its list of touches."""

    profile: Profile
    filled: Filled
    encoders: bool
    """Whether readings are encoder angles; else x, y, z."""
    table: pl.DataFrame
    """One row a touch."""

    def text(self, folder: str | Path) -> str:
        """The verify file as it stands in a folder: it names its profile from there."""
        return plan_toml(self.profile, self.filled, self.encoders, Path(folder))

    def save(self, folder: str | Path, force: bool = False) -> None:
        """Write plan.toml and touches.csv. Raises UlnaInputError."""
        with output_folder(folder, FILES, force) as staging:
            (staging / PLAN).write_text(self.text(folder), encoding="utf-8")
            self.table.write_csv(staging / TOUCHES)

    def counts(self) -> dict[str, int]:
        """Test → touches."""
        return {str(name): count for name, count in self.table.group_by("test", maintain_order=True).len().iter_rows()}


def make_test_plan(profile: str, arm: ArmLike | None = None, beside: Path = Path()) -> TestPlan:
    """What a profile (name or path) asks to be measured: as encoder readings of an arm, or as x, y, z of any arm.

    Raises UlnaInputError for a profile that cannot be used.
    """
    arm = None if arm is None else as_arm(arm)
    found = load_profile(profile, beside, "option --make-plan")
    names = ["x", "y", "z"] if arm is None else [f"q{k + 1}" for k in range(arm.n)]
    table = touches_table(found, {}).with_columns(pl.lit(None, dtype=pl.Float64).alias(name) for name in names)
    return TestPlan(found, EMPTY if arm is None else _of_arm(arm), arm is not None, table)


def _of_arm(arm: Arm) -> Filled:
    """What an arm file says of a plan already: its name, and the measuring range that such a reach has."""
    return Filled(arm=arm.name, range_mm=range_of(arm))


def play_test_plan(
    profile: str,
    truth: ArmLike,
    encoder_rad: float = 5e-6,
    touch_mm: float = 0.005,
    seed: int = 0,
    beside: Path = Path(),
    progress: Progress | None = None,
) -> TestPlan:
    """The same, measured by a virtual arm: a plan that can be evaluated at once, to try the whole way.

    encoder_rad and touch_mm: standard deviations. Artefacts, limits and temperature are examples. Raises
    UlnaInputError.
    """
    truth = as_arm(truth)
    found = load_profile(profile, beside, "option --make-plan")
    played = play(found, truth, encoder_rad, touch_mm, seed, progress)
    columns: dict[str, Any] = {f"q{k + 1}": played.q_rad[:, k] for k in range(truth.n)}
    return TestPlan(found, played.filled, True, touches_table(found, columns))
