"""An acceptance test, touched step by step: what `ulna verify` reads at its end."""

from __future__ import annotations

from pathlib import Path
from shutil import copyfile

import numpy as np

from ulna.formats.output import new_file, write_file
from ulna.formats.toml import read_toml
from ulna.live.figures import Calibrated
from ulna.live.stream import Stream
from ulna.serve.activities.laid import calibrated, folder_of, laid, touched_list
from ulna.serve.activities.stepwise import Stepwise
from ulna.serve.contract.guided import BeginTestTouches, TestState
from ulna.serve.desk import Desk
from ulna.serve.remarks import remarks
from ulna.verification.file import WHAT, VerifyPlan, load_verify
from ulna.verification.kinds.steps import Step
from ulna.verification.own_readings import angles_table, arm_of, begun, table_of
from ulna.verification.profile import load_profile
from ulna.verification.tables import State
from ulna.verification.to_touch import WorkList, work_list
from ulna.verification.verify import FILE, TABLE, verify

TEST, FOLDER = "test.toml", "verification"


class Testing(Stepwise):
    """Of one arm in one state."""

    kind = "test"
    _state: State

    def state(self) -> TestState:
        """All of it."""
        return TestState(kind="test", state=self._state, **self._common())

    def _table(self) -> Path:
        return self._folder / table_of(self._state)

    def _written(self) -> VerifyPlan:
        steps, q_rad = self._readings()
        arm = self.by_list.arm
        with new_file(self._table(), force=True) as staged:
            angles_table(steps, q_rad, arm.arm, arm.probe).write_csv(staged)
        return load_verify(self._folder / TEST)

    def _outcome(self) -> tuple[list[tuple[str, Path]], list[str]]:
        with remarks() as said:
            found = verify(self._folder / TEST)
        found.save(self._folder / FOLDER, force=True)
        made = [("verification", FILE), ("values", TABLE)]
        return [("test", self._folder / TEST), *((role, self._folder / FOLDER / name) for role, name in made)], said


def begun_test(asked: BeginTestTouches, stream: Stream, desk: Desk, folder: Path) -> Testing:
    """Raises UlnaInputError, before anything is touched, for whatever cannot be used; so where the arm as left is asked
    for and the arm as found, which the file lists, is not touched yet."""
    with folder_of(folder):
        arm = desk.path(asked.arm)
        arm_file = folder / arm_of(asked.state, arm.suffix.lower())
        copyfile(arm, arm_file)
        if not (folder / TEST).exists() or asked.go_on is None:
            given = laid(desk, asked.test, asked.beside, folder)
            text = begun(given.read_text(encoding="utf-8"), given, asked.state, arm_file.name, folder)
            write_file(folder / TEST, text, force=True)
        work, ready = _tried(folder, asked.state, arm_file, asked.probe)
        profile = work.plan.profile.file.name
        head = {"profile": profile, "state": asked.state}
        by_list = touched_list(stream, ready, work, folder, asked.by, lambda: head)
        return Testing(by_list, folder, asked.by, profile, asked.state)


def _tried(folder: Path, state: State, arm_file: Path, probe: str | None) -> tuple[WorkList, Calibrated]:
    """The list and the arm, once it is known that what is to be touched can be evaluated."""
    table = folder / table_of(state)
    bare = calibrated(arm_file, probe, 20.0, None)
    if table.exists():
        plan = load_verify(folder / TEST)
    else:
        document, _ = read_toml(folder / TEST, WHAT)
        profile = load_profile(str(document.get("profile")), folder, f"{TEST}: key 'profile'")
        step = Step(next(iter(profile.file.test)))
        angles_table([(0, step)], np.zeros((1, bare.arm.n)), bare.arm, bare.probe).write_csv(table)
        try:
            plan = load_verify(folder / TEST)
        finally:
            table.unlink()
    temperature = plan.file.temperature
    ready = calibrated(arm_file, probe, None if temperature is None else temperature.value, None)
    work = work_list(plan, ready.ball_mm)
    work.check(state)
    return work, ready
