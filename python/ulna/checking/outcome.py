"""What a check found: figures of each place, judged by their limits and by their history. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

from ulna.checking.advice import advice
from ulna.checking.series import History
from ulna.ground.worded import worded
from ulna.verification.figures.figure import Definition
from ulna.verification.outcome import Judged

BROKEN = worded("its limit is broken")


@dataclass(frozen=True)
class Checked:
    """A figure of one place."""

    test: str
    kind: str
    definition: Definition
    judged: Judged
    history: History | None
    """None where no history was named."""

    @property
    def called(self) -> str:
        """`E_Uni, bar, left`: with its labels."""
        return ", ".join([self.definition.key, *self.judged.single.labels.as_dict().values()])

    @property
    def whys(self) -> list[str]:
        """What is out, in words; [] where nothing is."""
        limit = [BROKEN] if self.judged.decided.verdict == "fail" else []
        return limit + ([] if self.history is None else [signal.words for signal in self.history.signals])

    @property
    def slow(self) -> bool:
        """Whether only several checks together show it."""
        failed = self.judged.decided.verdict == "fail"
        return not failed and self.history is not None and all(signal.slow for signal in self.history.signals)


@dataclass(frozen=True)
class Advice:
    """What to try where figures of a test are out."""

    test: str
    figures: list[str]
    why: list[str]
    steps: list[str]


def advised(figures: list[Checked]) -> list[Advice]:
    """For each test of which a figure is out."""
    found = []
    kinds = {figure.test: figure.kind for figure in figures}
    for test, kind in kinds.items():
        out = [figure for figure in figures if figure.test == test and figure.whys]
        if out:
            others = {each: False for name, each in kinds.items() if name != test}
            for figure in figures:
                if figure.test != test:
                    others[figure.kind] |= bool(figure.whys)
            steps = advice(kind, all(figure.slow for figure in out), others)
            whys = list(dict.fromkeys(why for figure in out for why in figure.whys))
            found.append(Advice(test, [figure.called for figure in out], whys, steps))
    return found
