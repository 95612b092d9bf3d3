"""A check before work, touched step by step: what `ulna check` reads at its end."""

from __future__ import annotations

import tempfile
from pathlib import Path
from shutil import copyfile

import numpy as np

from ulna.checking.check import check
from ulna.checking.protocol import Protocol, load_protocol, plan_of
from ulna.checking.result_file import load_check
from ulna.checking.to_touch import check_written, named_as_before, readings_text
from ulna.formats.output import write_file
from ulna.live.by_list import ByList
from ulna.live.figures import Calibrated
from ulna.live.stream import Stream
from ulna.records.bench import Bench
from ulna.records.outcomes import Recording
from ulna.serve.activities.laid import calibrated, folder_of, touched_list
from ulna.serve.activities.stepwise import Stepwise
from ulna.serve.beside import usable, with_arm
from ulna.serve.contract.guided import BeginCheckTouches, CheckState
from ulna.serve.desk import Desk
from ulna.serve.remarks import remarks
from ulna.verification.file import VerifyPlan
from ulna.verification.kinds.steps import Step
from ulna.verification.to_touch import WorkList, work_list

READINGS, CHECK = "readings.csv", "check.json"


class Checking(Stepwise):
    """Of one arm."""

    kind = "check"

    def __init__(
        self,
        by_list: ByList,
        folder: Path,
        by: str,
        protocol: Protocol,
        arm_file: Path,
        history: list[Path] | None,
        operator: str | None,
    ) -> None:
        """history: earlier checks of the record; None: of no arm of it."""
        self._protocol, self._arm_file = protocol, arm_file
        self._history, self._operator = history, operator
        super().__init__(by_list, folder, by, protocol.file.name, "as-found")

    def state(self) -> CheckState:
        """All of it."""
        return CheckState(kind="check", **self._common())

    def _table(self) -> Path:
        return self._folder / READINGS

    def _written(self) -> VerifyPlan:
        steps, q_rad = self._readings()
        arm = self.by_list.arm
        text = readings_text(self._protocol, arm.arm, self._arm_file, steps, q_rad, arm.tips_mm(q_rad), arm.probe)
        write_file(self._table(), text, force=True)
        return plan_of(self._protocol, self._table())

    def _outcome(self) -> tuple[list[tuple[str, Path]], list[str]]:
        earlier = () if self._history is None else self._history
        with remarks() as said:
            found = check(self._protocol.path, self._table(), earlier, None, self._operator)
        found.save(self._folder / CHECK)
        return [("check", self._folder / CHECK)], said


def begun_check(asked: BeginCheckTouches, stream: Stream, desk: Desk, bench: Bench, folder: Path) -> Checking:
    """Raises UlnaInputError, before anything is touched, for whatever cannot be used."""
    given, arm = usable(desk, asked.protocol), desk.path(asked.arm)
    name = load_protocol(given).file.name
    history = None if asked.of is None else Recording.at(bench, asked.of).checks(name)
    with folder_of(folder):
        arm_file = folder / f"arm{arm.suffix.lower()}"
        copyfile(arm, arm_file)
        (folder / given.name).write_text(with_arm(given.read_text(encoding="utf-8"), arm_file.name), encoding="utf-8")
        protocol = load_protocol(folder / given.name)
        check_written(protocol)
        file = protocol.file
        temperature_c = None if file.temperature is None else file.temperature.value
        ready = calibrated(arm_file, asked.probe or file.readings.probe, temperature_c, file.readings.payload)
        work = _tried(protocol, ready, arm_file)
        if history:
            newest = max((load_check(each) for each in history), key=lambda each: each[1])[0]
            work = named_as_before(work, newest.figures)
        by_list = touched_list(stream, ready, work, folder, asked.by, lambda: {"protocol": protocol.file.name})
        return Checking(by_list, folder, asked.by, protocol, arm_file, history, asked.operator)


def _tried(protocol: Protocol, arm: Calibrated, arm_file: Path) -> WorkList:
    """The list, once what is to be written can be read, and what was read can be evaluated."""
    with tempfile.TemporaryDirectory(prefix="ulna-") as place:
        trial = Path(place) / READINGS
        step = Step(next(iter(protocol.file.test)))
        q_rad, p_mm = np.zeros((1, arm.arm.n)), np.zeros((1, 3))
        text = readings_text(protocol, arm.arm, arm_file, [(0, step)], q_rad, p_mm, arm.probe)
        trial.write_text(text, encoding="utf-8")
        plan = plan_of(protocol, trial)
    ball_mm = plan.bench.mm * (protocol.file.ball or 0.0) if protocol.file.arm is None else arm.ball_mm
    work = work_list(plan, ball_mm)
    work.check("as-found")
    return work
