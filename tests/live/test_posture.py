"""The posture in which an arm is commissioned: its words are true of the arm, and zeros follow from it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.live.home_built import HomeBuilt
from tests.live.test_commission import drawn

import ulna
from ulna.arm.arm import Arm
from ulna.ground.errors import UlnaInputError
from ulna.live.commission.commissioning import Commissioning
from ulna.live.commission.posture import direction, posture
from ulna.live.commission.writing import arm_text, commissioned, noise_text
from ulna.live.samples import Samples
from ulna.live.tables import MapTable
from ulna.proposals.arms import Drawn, by_reach

TO = {"forward": (1, 0, 0), "back": (-1, 0, 0), "to the left": (0, 1, 0), "to the right": (0, -1, 0)}
TO |= {"straight up": (0, 0, 1), "straight down": (0, 0, -1)}
SEEN = {"in front": (1, 0, 0), "behind": (-1, 0, 0), "the left": (0, 1, 0), "the right": (0, -1, 0)}
SEEN |= {"above": (0, 0, 1), "below": (0, 0, -1)}


ARMS = [
    *(by_reach(axes, 900, parallel, "drawn").arm for axes, parallel in ((6, ["none"]), (7, ["none"]), (6, ["2"]))),
    ulna.Arm.load("examples/platinum/platinum.toml"),
]


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: f"{arm.name}-{arm.n}")
def test_the_words_are_true_of_the_arm(arm: Arm) -> None:
    """Turned by a little in the direction that is said to be positive, the tip goes where it is said to go; a joint
    that the tip does not show turns anticlockwise as seen from there."""
    found = posture(arm)
    theta0 = np.array([joint.theta0_rad for joint in arm.joints])
    q_rad = arm.signs * (found.turned_rad + theta0)
    here = arm.tip(q_rad[None])[0]
    shown = 0
    for k, way in enumerate(found.ways):
        more = q_rad.copy()
        more[k] += 1e-4 * arm.signs[k]
        step = arm.tip(more[None])[0] - here
        said = way.removeprefix("so that the tip goes ")
        if said in TO:
            assert step @ TO[said] > 0.98 * np.linalg.norm(step)
            shown += 1
        elif said != way:  # two words, and an angle
            assert step @ TO[said.split(",")[0]] > 0.2 * np.linalg.norm(step)
            shown += 1
        else:
            assert way.startswith("anticlockwise, seen from ")
            axis = np.array(SEEN[way.removeprefix("anticlockwise, seen from ")])
            ahead = arm.tip((q_rad + 1e-4 * (np.arange(arm.n) == k) * arm.signs)[None])[0] - here
            # the rotation about that axis, by how the tip goes about the last joint's axis
            assert np.linalg.norm(ahead) == 0.0 or abs(ahead @ axis) < 0.3 * np.linalg.norm(ahead)
    assert shown >= arm.n - 1


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: f"{arm.name}-{arm.n}")
def test_it_lies_above_the_table_and_its_lengths_are_those_of_the_arm(arm: Arm) -> None:
    found = posture(arm)
    theta0 = np.array([joint.theta0_rad for joint in arm.joints])
    tip = arm.tip((arm.signs * (found.turned_rad + theta0))[None])[0]
    assert tip[2] > -0.05 * arm.core.reach_mm(0)
    lengths = [float(line.split(": ")[1].split(" mm")[0]) for line in found.words]
    assert np.linalg.norm(tip) - 5.0 <= sum(lengths) <= 1.3 * arm.core.reach_mm(0)
    assert found.words[-1].split(":")[0].endswith("to the tip")


def test_directions_in_words() -> None:
    assert direction(np.array([3.0, 0.1, 0.0])) == "forward"
    assert direction(np.array([0.0, -2.0, 0.0])) == "to the right"
    assert direction(np.array([0.0, 0.1, -2.0])) == "straight down"
    assert direction(np.array([1.0, 0.0, 1.0])) == "forward, 45° above level"
    assert direction(np.array([-2.0, 1.0, 0.0])) == "back, turned 27° to the left"


@settings(max_examples=5, deadline=None)
@given(
    st.permutations(range(6)),
    st.lists(st.sampled_from([1, -1]), min_size=6, max_size=6),
    st.integers(0, 999),
    st.floats(0.0, 5.0),
)
def test_zeros_are_as_good_as_the_posture_was_taken(
    order: list[int], signs: list[int], seed: int, by_eye: float
) -> None:
    """By as much as a joint was off in the posture its zero is off, whatever the encoder counts and wherever it begins
    again."""
    arm, base = HomeBuilt(order, signs, 6, seed), drawn(6)
    wanted = posture(base)
    off = np.radians(by_eye) * np.random.default_rng(seed).uniform(-1.0, 1.0, 6)
    table = MapTable(unit="counts", counts_per_turn=4096)
    work = Commissioning(arm.hello, 6, table, posture=wanted)
    found = work.take(arm.samples(arm.whole(posture_rad=wanted.turned_rad + off), 0.0))
    while found is not None:
        assert found.why_not is None, found.said
        work.accept()
        found = work.take(Samples.none(6))
    assert work.step is None
    made = commissioned(work.findings(), base)
    assert made.signs.tolist() == signs
    # at any turns of the joints: what is read, by the arm that was found
    q_rad = np.random.default_rng(seed + 1).uniform(-1.0, 1.0, (5, 6))
    read_rad = arm.counts(q_rad)[:, order] / 4096 * 2 * np.pi
    assert np.abs(made.tip(read_rad) - base.tip(q_rad - off)).max() < 10 * 2 * np.pi / 4096 * base.core.reach_mm(0)


def test_without_a_right_angle_it_is_asked_for() -> None:
    arm = drawn(4)
    joints = [replace(joint, limits_rad=(0.2, 1.2)) for joint in arm.joints]
    narrow = replace(arm, joints=tuple(joints))
    with pytest.raises(UlnaInputError, match=r"joint 2 is at a right angle nowhere .* --posture"):
        posture(narrow)
    assert posture(narrow, [0.3, 0.4, 0.5, 0.6]).turned_rad.tolist() == [0.3, 0.4, 0.5, 0.6]


def test_left_out_the_zeros_and_signs_stay_unknown() -> None:
    arm, base = HomeBuilt([0, 1, 2, 3], [1, 1, -1, 1], 4, 5), drawn(4)
    work = Commissioning(arm.hello, 4, posture=posture(base))
    found = work.take(arm.samples(arm.whole(posture_rad=np.ones(4), ways=[]), 0.0))
    while found is not None and work.step is not None and work.step.kind != "posture":
        work.accept()
        found = work.take(Samples.none(4))
    work.skip()
    assert work.step is None
    made = commissioned(work.findings().with_counts(4096.0), base)
    assert [joint.sign for joint in made.joints] == [0] * 4
    assert not work.findings().zeroed


def test_zeros_that_somebody_knows_stay() -> None:
    """Those of the drawing, with the signs that were found; nothing has to be searched for."""
    arm, base = HomeBuilt([0, 1, 2, 3], [1, -1, -1, 1], 4, 5), drawn(4)
    base = replace(base, joints=tuple(replace(joint, theta0_rad=0.3 * (k < 3)) for k, joint in enumerate(base.joints)))
    work = Commissioning(arm.hello, 4, ways=["so"] * 4)
    found = work.take(arm.samples(arm.whole(), 0.0))
    while found is not None:
        work.accept()
        found = work.take(Samples.none(4))
    findings = replace(work.findings().with_counts(4096.0), as_drawn=True)
    made = commissioned(findings, base)
    assert [joint.theta0_rad for joint in made.joints] == [0.3, 0.3, 0.3, 0.0]
    assert [joint.sign for joint in made.joints] == [1, -1, -1, 1]
    assert "search" not in noise_text(findings) + arm_text(findings, Drawn(base, "as drawn"))
