"""Checks and acceptance tests, as jobs."""

from __future__ import annotations

from pathlib import Path

from ulna.checking.check import check
from ulna.checking.protocol import load_protocol
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.records.outcomes import Recording
from ulna.serve.beside import together, usable, with_arm
from ulna.serve.contract.jobs import BeginCheck, BeginVerify
from ulna.serve.jobs import Made, Planned, Progress
from ulna.serve.remarks import remarks
from ulna.serve.workshop import Workshop
from ulna.verification.verify import FILE, TABLE, verify

CHECK = "check.json"


def check_work(asked: BeginCheck, workshop: Workshop, folder: Path) -> Planned:
    """Raises UlnaInputError for what is not on the desk, or no protocol."""
    desk = workshop.desk
    stated = load_protocol(usable(desk, asked.protocol))
    named = {}
    if asked.arm is not None:
        if stated.file.arm is None:
            raise UlnaInputError(
                f"{stated.path.name}: names no arm: its readings are x, y, z; expected no arm. Leave it out."
            )
        named = {desk.info(asked.arm).name: asked.arm}
    protocol = together(desk, folder, asked.protocol, asked.beside, named)
    if named:
        protocol.write_text(with_arm(protocol.read_text(encoding="utf-8"), next(iter(named))), encoding="utf-8")
    readings = desk.path(asked.readings)
    history = [desk.path(each) for each in asked.history]
    if asked.of is not None:
        history += Recording.at(workshop.records.bench, asked.of).checks(stated.file.name)
    earlier = history if asked.history or asked.of is not None else ()

    def work(progress: Progress) -> Made:
        progress("check", 0, 1)
        with remarks() as said:
            found = check(protocol, readings, earlier, asked.date, asked.operator)
        found.save(folder / CHECK)
        return Made([("check", folder / CHECK)], said)

    return worded("check '{protocol}'", protocol=stated.file.name), work


def verify_work(asked: BeginVerify, workshop: Workshop, folder: Path) -> Planned:
    """Raises UlnaInputError for what is not on the desk."""
    test = together(workshop.desk, folder, asked.test, asked.beside)
    arm = None if asked.arm is None else workshop.desk.path(asked.arm)

    def work(progress: Progress) -> Made:
        with remarks() as said:
            found = verify(test, arm)
        progress("verify", 1, 1)
        found.save(folder / "verification")
        return Made(
            [("verification", folder / "verification" / FILE), ("table", folder / "verification" / TABLE)], said
        )

    return worded("test by {file}", file=test.name), work
