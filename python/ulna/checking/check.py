"""Check: a few touches before work, from a protocol and its readings to judged figures."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from ulna.checking.history import Earlier, load_history, past
from ulna.checking.outcome import Advice, Checked, advised
from ulna.checking.outcome_tables import advice_table, checked_table, of_verification
from ulna.checking.protocol import Protocol, load_protocol, plan_of
from ulna.checking.result_file import FORMAT, CheckFile, UsedProtocol, time_of
from ulna.checking.series import History, judged
from ulna.formats.output import refuse_inputs, write_file
from ulna.ground.errors import InputWarning
from ulna.ground.shown import About, Shown, Table
from ulna.ground.worded import worded
from ulna.verification.decision import Verdict
from ulna.verification.departures import OF_TEST
from ulna.verification.verify import Verification, evaluated

Paths = Iterable[str | os.PathLike[str]]


@dataclass(frozen=True, repr=False)
class Check(Shown):
    """What a check found."""

    protocol: Protocol
    verification: Verification
    """The same touches as an acceptance test: figures, uncertainties, what departs from the protocol."""
    time: datetime
    """When it was measured."""
    operator: str | None
    figures: list[Checked]
    """Of each place, in the order of the protocol."""
    history: list[Earlier]
    """Earlier checks that it was judged by, in order of time."""
    remarks: list[str]

    @property
    def verdict(self) -> Verdict | None:
        """The worst of all limits; None where none was stated."""
        return self.verification.verdict

    @property
    def in_control(self) -> bool | None:
        """Whether all figures with a history of enough checks are; None where none has one."""
        said = [each.history.in_control for each in self.figures if each.history is not None]
        known = [each for each in said if each is not None]
        return all(known) if known else None

    @property
    def broken(self) -> bool:
        """Whether a limit or a history is."""
        return any(figure.whys for figure in self.figures)

    @property
    def advice(self) -> list[Advice]:
        """What to try, for each test of which a figure is out."""
        return advised(self.figures)

    @property
    def departures(self) -> list[str]:
        """In words: where what was measured is not what the protocol counts."""
        (state,) = self.verification.states
        return [
            *(worded(OF_TEST, test=test.name, departure=text) for test in state.tests for text in test.departures),
            *state.departures,
        ]

    def about(self) -> About:
        """Each figure in each place, with its limit and what its history says."""
        rows = [
            [
                each.called,
                f"{1000.0 * each.judged.single.value_mm:.1f}",
                "–" if each.judged.limit_mm is None else f"{1000.0 * each.judged.limit_mm:.1f}",
                each.judged.decided.verdict or "–",
                said_of(each.history),
            ]
            for each in self.figures
        ]
        return About(
            f"Check '{self.protocol.file.name}' of '{self.verification.arm}': {self.verdict or 'no limit stated'}",
            {"measured": f"{self.time:%Y-%m-%d %H:%M}", "earlier checks": str(len(self.history))},
            [Table(["figure", "value / µm", "limit / µm", "verdict", "history"], rows)],
            self.remarks,
        )

    def file(self) -> CheckFile:
        """`ulna-check/1`, lengths in mm."""
        return CheckFile(
            format=FORMAT,
            protocol=UsedProtocol(
                name=self.protocol.file.name, path=str(self.protocol.path), sha256=self.protocol.sha256
            ),
            time=self.time.isoformat(timespec="seconds"),
            operator=self.operator,
            verdict=self.verdict,
            in_control=self.in_control,
            figures=[checked_table(each, self.verification.rule.k) for each in self.figures],
            departures=self.departures,
            advice=[advice_table(each) for each in self.advice],
            **of_verification(self.verification.file(), self.history, self.remarks),
        )

    def as_dict(self) -> dict[str, Any]:
        """The same: JSON types only."""
        return self.file().model_dump()

    def save(self, path: str | Path, force: bool = False) -> None:
        """Write it as JSON, a file of the history to come. Raises UlnaInputError, also where the file is one that this
        check was made from."""
        plan = self.verification.plan
        read = [each.path for parts in plan.touches.values() for each in parts]
        arms = [each.path for each in plan.arms]
        refuse_inputs([Path(path)], [self.protocol.path, *read, *arms, *(each.path for each in self.history)])
        text = json.dumps(self.as_dict(), indent=1, ensure_ascii=False, allow_nan=False)
        write_file(path, text + "\n", force)


def check(
    protocol: str | os.PathLike[str],
    readings: str | os.PathLike[str],
    history: Paths | str | os.PathLike[str] = (),
    date: str | datetime | None = None,
    operator: str | None = None,
) -> Check:
    """A check by a protocol: `readings` a table of its touches; `history` results of earlier checks, or folders of
    them, by which each figure is judged besides.

    date: when it was measured, ISO 8601 or with a time zone; None: now. operator: who did. Raises UlnaInputError for
    whatever cannot be used. Warns with InputWarning of what is used with a remark, or is not used.
    """
    known = load_protocol(Path(protocol))
    time = _when(date)
    found = evaluated(plan_of(known, Path(readings)))
    remarks = list(found.plan.warnings)
    ((touches,),) = found.plan.touches.values()
    paths = [history] if isinstance(history, str | os.PathLike) else list(history)
    earlier = load_history(paths, known.file.name, found.arm, touches, time, remarks)
    for remark in remarks:
        warnings.warn(remark, InputWarning, stacklevel=2)
    figures = _figures(found, earlier if paths else None, known)
    return Check(known, found, time, operator, figures, earlier, remarks)


def _when(date: str | datetime | None) -> datetime:
    if date is None:
        return datetime.now().astimezone()
    return date.astimezone() if isinstance(date, datetime) else time_of(date, "date")


def _figures(found: Verification, earlier: list[Earlier] | None, protocol: Protocol) -> list[Checked]:
    (state,) = found.states
    figures = []
    for test in state.tests:
        for figure in test.figures:
            for each in figure.values:
                history = None
                if earlier is not None:
                    before = past(earlier, test.name, figure.definition.key, each.single.labels)
                    history = judged(before, each.single.value_mm, figure.definition.signed, protocol.file.control)
                figures.append(Checked(test.name, test.kind, figure.definition, each, history))
    return figures


def said_of(history: History | None) -> str:
    """In a few words."""
    if history is None:
        return "–"
    if history.basis.too_few:
        return f"too few ({history.earlier})"
    return "in control" if history.in_control else "OUT"
