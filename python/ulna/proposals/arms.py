"""The arm to start from: what a drawing says, or what a person can say who has none: how far it reaches."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ulna.arm.arm import Arm
from ulna.arm.frames.links import hayati_where_parallel
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.exchange.importers.dh import arm_from_table
from ulna.exchange.importers.dh_table import read_dh
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import read_chain
from ulna.exchange.urdf.units import in_units
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import listed, worded
from ulna.proposals.answers import Answers, Question

HAND = 0.2
"""Of the reach: from the wrist to the tip; the links before it share the rest."""
ASIDE = 0.02
"""Of the reach: how far the tip stands off the last axis, since a tip on it could not show where it points."""
LEAST_AXES = 4


@dataclass(frozen=True)
class Drawn:
    """An arm as somebody drew it, and what was said of it."""

    arm: Arm
    said: str
    """Where it comes from, in words."""
    files: tuple[Path, ...] = ()
    joint_names: tuple[str | None, ...] | None = None
    """None: nothing is known of the joints, not even their number."""
    remarks: tuple[str, ...] = ()
    guessed: bool = False
    """Whether nobody drew it."""


def drawn_arm(answers: Answers) -> Drawn | list[Question] | None:
    """The arm of a drawing; None where there is only a reach, or nothing: `by_reach` needs the number of axes. Raises
    UlnaInputError for a drawing that cannot be used."""
    if answers.arm is not None:
        arm = Arm.load(answers.arm)
        return Drawn(arm, worded("as {file} says", file=str(answers.arm)), (answers.arm,), _names(arm))
    if answers.dh is not None:
        if answers.convention is None:
            return [
                Question(
                    "convention",
                    "--convention dh or modified-dh",
                    worded(
                        "does a row of the DH table hold alpha and a after its joint (dh) or before it (modified-dh)"
                    ),
                    ("dh", "modified-dh"),
                )
            ]
        convention: Any = answers.convention
        table = read_dh(answers.dh, answers.length_unit, answers.angle_unit)
        found = arm_from_table(table, convention, answers.tip)
        return Drawn(
            found.arm,
            worded("of the table {file}", file=answers.dh.name),
            (answers.dh,),
            _names(found.arm),
            tuple(found.remarks),
        )
    if answers.urdf is not None:
        chain = in_units(
            read_chain(answers.urdf, answers.tip_link, answers.base_link), answers.length_unit, answers.angle_unit
        )
        arm, _ = arm_from_chain(chain)
        said = worded(
            "of {file}, from link '{base}' to link '{tip}'",
            file=answers.urdf.name,
            base=chain.base_link,
            tip=chain.tip_link,
        )
        return Drawn(arm, said, (answers.urdf,), _names(arm), tuple(chain.remarks))
    return None


def _names(arm: Arm) -> tuple[str | None, ...]:
    return tuple(joint.name for joint in arm.joints)


DRAWING = Question(
    "drawing",
    "--reach MM, --dh TABLE, --urdf FILE or --arm FILE",
    worded("what is known of the arm: a table or a drawing of it, or how far it reaches from its base to the tip"),
)


PARALLEL = Question(
    "parallel",
    "--parallel N, once for each, or --parallel none",
    worded(
        "which axes, counted from the base, are parallel to the next one, or none (all stand across their neighbours)"
    ),
)


def by_reach(axes: int, reach_mm: float, parallel: Sequence[str], name: str) -> Drawn:
    """An arm as most are built. parallel: axes that are parallel to the next, by number, or "none"; all others are at
    right angles to it. Links go along every second axis of those, and from axis to axis where two are parallel, and are
    of one length. With zeros and signs searched for, a fit finds what the arm really is.

    Raises UlnaInputError for too few axes, and numbers that are none.
    """
    if axes < LEAST_AXES:
        raise UlnaInputError(
            f"--reach: an arm of {axes} axes is not drawn from its reach alone; expected at least {LEAST_AXES} axes, "
            "or a drawing. Give --dh, --urdf or --arm."
        )
    if list(parallel) != ["none"] and not all(each.isdecimal() and 1 <= int(each) < axes for each in parallel):
        raise UlnaInputError(
            f"--parallel: got {' '.join(parallel)}; expected none, or numbers from 1 to {axes - 1} of axes that are "
            "parallel to the next one. Correct it."
        )
    to_next = [str(k) in parallel for k in range(1, axes)]
    along = [True]  # whether the arm's links go along the axis
    for same in to_next[:-1]:
        along.append(along[-1] if same else not along[-1])
    long = [same or (own and k > 0) for k, (same, own) in enumerate(zip(to_next, along, strict=True))]
    link_mm = (1.0 - HAND) * reach_mm / max(1, sum(long))
    side = -1.0
    joints = []
    for same, has in zip(to_next, long, strict=True):
        alpha_rad = 0.0 if same else side * math.pi / 2
        side = side if same else -side
        joints.append(Joint(0.0, alpha_rad, link_mm if same else 0.0, link_mm if has and not same else 0.0))
    tip = Probe(ASIDE * reach_mm, 0.0, HAND * reach_mm)
    made, probes, _ = hayati_where_parallel((*joints, Joint()), {"tip": tip})
    twos = listed([worded("{one} and {other}", one=k, other=k + 1) for k in range(1, axes) if to_next[k - 1]])
    how = (
        worded("axes {pairs} parallel, the others across their neighbours", pairs=twos)
        if twos
        else worded("each axis across its neighbours")
    )
    said = worded("nobody drew it: {how}, {reach} mm from base to tip", how=how, reach=f"{reach_mm:g}")
    return Drawn(Arm(name, tuple(made), probes), said, guessed=True)


def encoder_questions(drawn: Drawn, answers: Answers) -> list[Question]:
    """Whether the encoders' zeros and signs are those of the drawing: nobody knows but the owner."""
    if drawn.guessed:
        return []
    choices = ("known", "unknown")
    asked = []
    if answers.zeros is None:
        asked.append(
            Question(
                "zeros",
                "--zeros known or unknown",
                worded("are the encoders' zeros those of the drawing (known), or wherever they were mounted (unknown)"),
                choices,
            )
        )
    if answers.signs is None:
        asked.append(
            Question(
                "signs",
                "--signs known or unknown",
                worded("does each encoder count the way the drawing turns"),
                choices,
            )
        )
    return asked


def as_asked(drawn: Drawn, answers: Answers, probes: Sequence[str]) -> tuple[Arm, bool]:
    """The arm as its file will say it, and whether its zeros are to be searched for. probes: names of the probes in the
    readings, () where they name none. Raises UlnaInputError."""
    zeros = "unknown" if drawn.guessed else answers.zeros
    signs = "unknown" if drawn.guessed else answers.signs
    arm = drawn.arm
    if answers.signs == "known" and drawn.guessed:
        signs = "known"
    joints = list(arm.joints)
    if signs == "unknown":
        joints = [replace(joint, sign=0) for joint in joints]
    if zeros == "unknown" or signs == "unknown":  # limits are angles of the encoder, of which nothing is known
        joints = [replace(joint, limits_rad=None) for joint in joints]
    if answers.counts_per_turn:
        each = answers.counts_per_turn * arm.n if len(answers.counts_per_turn) == 1 else answers.counts_per_turn
        if len(each) != arm.n:
            raise UlnaInputError(
                f"--counts-per-turn: got {len(each)} numbers, expected one, or {arm.n}: one for each axis. Correct it."
            )
        joints = [replace(joint, counts_per_turn=counts) for joint, counts in zip(joints, each, strict=True)]
    tips = dict(arm.probes)
    if answers.ball is not None:
        tips = {name: replace(tip, ball_mm=answers.ball) for name, tip in tips.items()}
    if probes and len(tips) == 1:
        tip = next(iter(tips.values()))
        tips = dict.fromkeys(probes, tip)
    return replace(arm, joints=tuple(joints), probes=tips), zeros == "unknown"
