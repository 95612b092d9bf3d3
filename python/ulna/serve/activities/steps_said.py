"""A list that is touched, as it goes over the wire."""

from __future__ import annotations

from collections.abc import Sequence

from ulna.ground.worded import recalled, worded
from ulna.live.by_list import ByList, OfStep
from ulna.live.said import length_said
from ulna.live.touches import Touch
from ulna.serve.contract import activities, guided
from ulna.serve.contract.model import Value
from ulna.serve.texts import length, valued
from ulna.verification.as_it_falls import Fallen, SoFar
from ulna.verification.decision import Verdict, worst_verdict
from ulna.verification.departures import FIGURES, VERDICTS, said_of
from ulna.verification.to_touch import WorkList

TOLD = 40
"""Touches that a page is told of: the newest."""
_LABELS = ("artefact", "position", "orientation", "repeat")


def _labels(work: WorkList, k: int) -> dict[str, str]:
    step = work.listed[k].step
    kind = work.plan.profile.file.test[step.test].kind
    return {"test": step.test, "kind": kind, **{name: getattr(step, name) for name in _LABELS}}


def present_said(by_list: ByList) -> guided.StepNow | None:
    """What is to be touched; None where all is."""
    k, work = by_list.step, by_list.work
    if k is None:
        return None
    step = work.listed[k].step
    own = [j for j in _part_of(work, k) if work.listed[j].step.feature == step.feature]
    return guided.StepNow(
        **_labels(work, k), number=k + 1, feature=step.feature, now=own.index(k) + 1, all=len(own), what=step.what
    )


def parts_said(by_list: ByList, known: SoFar) -> tuple[list[guided.Part], list[guided.FigureNow]]:
    """Each measurement with its figures, and figures of several together."""
    work, there = by_list.work, by_list.counting
    owners = _owners(work, known.values)
    parts = []
    for number, part in enumerate(work.parts):
        own = [each for each, owner in zip(known.values, owners, strict=True) if owner == number]
        verdicts: list[Verdict | None] = [each.judged.decided.verdict for each in own]
        parts.append(
            guided.Part(
                **_labels(work, part[0]),
                first=part[0] + 1,
                touched=sum(k in there for k in part),
                touches=len(part),
                figures=[figure_said(each) for each in own],
                verdict=worst_verdict(verdicts),
            )
        )
    return parts, [figure_said(each) for each, owner in zip(known.values, owners, strict=True) if owner is None]


def _owners(work: WorkList, values: Sequence[Fallen]) -> list[int | None]:
    """Of each value the only measurement that it can be of; None where it is of several together."""
    parts: dict[str, list[tuple[int, dict[str, str]]]] = {}
    for number, part in enumerate(work.parts):
        own = _labels(work, part[0])
        parts.setdefault(own["test"], []).append((number, own))
    owners = []
    for value in values:
        labels = value.judged.single.labels.as_dict().items()
        found = [n for n, own in parts[value.test] if all(own[name] in ("", text) for name, text in labels)]
        owners.append(found[0] if len(found) == 1 else None)
    return owners


def figure_said(found: Fallen) -> guided.FigureNow:
    """One value against its limit."""
    single, decided, unit = found.judged.single, found.judged.decided, found.definition.unit
    u_mm, limit_mm = single.budget.u_mm, found.judged.limit_mm
    return guided.FigureNow(
        test=found.test,
        key=found.definition.key,
        name=recalled(found.definition.name, FIGURES),
        of=list(single.labels.as_dict().items()),
        value=valued(single.value_mm, unit, u_mm, None if u_mm is None else found.k * u_mm),
        limit=None if limit_mm is None else valued(limit_mm, unit),
        guard=None if decided.guard_mm is None else length(decided.guard_mm),
        verdict=decided.verdict,
        why=None if decided.why is None else said_of(decided.why),
    )


def touches_said(by_list: ByList) -> list[guided.StepTouch]:
    """The newest."""
    return [
        guided.StepTouch(
            number=each.number,
            step=by_list.steps[each.number] + 1,
            feature=by_list.work.listed[by_list.steps[each.number]].step.feature,
            place=_place(by_list, each),
            spread=length(each.spread_mm),
            scatter=_scatter(by_list, each),
            withdrawn=each.withdrawn,
        )
        for each in by_list.touches[-TOLD:]
    ]


def _scatter(by_list: ByList, touch: Touch) -> Value | None:
    found = by_list.scatter_mm(by_list.steps[touch.number]) if touch is by_list.last else None
    return None if found is None else length(found)


def _place(by_list: ByList, touch: Touch) -> str:
    step = by_list.work.listed[by_list.steps[touch.number]].step
    again = any(each.test == step.test and each.repeat != step.repeat for each in by_list.work.steps)
    said = [step.artefact or step.test, step.position, step.orientation, step.repeat if again else ""]
    return " ".join(each for each in said if each)


def taken_said(by_list: ByList, event: OfStep) -> activities.Touch:
    """A touch, as every activity tells it."""
    touch, step = event.touch, by_list.work.listed[event.step].step
    x, y, z = by_list.arm.tips_mm(touch.q_rad[None])[0].tolist()
    return activities.Touch(
        number=touch.number,
        feature=step.feature,
        place=_place(by_list, touch),
        held_out=False,
        withdrawn=None,
        tip_mm=(x, y, z),
        spread=length(touch.spread_mm),
        off=None,
        times=None,
        suspicious=False,
    )


def lines_of(by_list: ByList, event: OfStep) -> list[str]:
    """A touch that was taken, and the scatter in its seat."""
    touch, step = event.touch, by_list.work.listed[event.step].step
    lines = [
        worded(
            "Touch {number}, {what}: spread {spread}.",
            number=touch.number,
            what=step.what,
            spread=length_said(touch.spread_mm),
        )
    ]
    scatter_mm = by_list.scatter_mm(event.step)
    if scatter_mm is None:
        return lines
    return [*lines, worded("Scatter in its seat {scatter}.", scatter=length_said(scatter_mm))]


def fallen_lines(by_list: ByList, step: int, known: SoFar) -> list[str]:
    """What is known of the measurement of a step, of what has a limit."""
    part = next(k for k, each in enumerate(by_list.work.parts) if step in each)
    lines = []
    for each, owner in zip(known.values, _owners(by_list.work, known.values), strict=True):
        said = figure_said(each)
        if said.limit is not None and owner == part:
            of = {"key": said.key, "value": said.value.text, "limit": said.limit.text, "unit": said.limit.unit}
            if said.verdict is None:
                lines.append(worded("{key} {value} of {limit} {unit}.", **of))
            else:
                verdict = recalled(said.verdict, VERDICTS)
                lines.append(worded("{key} {value} of {limit} {unit}: {verdict}.", verdict=verdict, **of))
    return lines


def _part_of(work: WorkList, k: int) -> tuple[int, ...]:
    return next(part for part in work.parts if k in part)
