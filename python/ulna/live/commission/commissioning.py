"""An arm commissioned, step by step: what is to be done, what came of it, and what somebody says to that.

No terminal is in here: a command, a page or a recording drives it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.commission.counting import Known
from ulna.live.commission.findings import Findings, FoundJoint, found_joint
from ulna.live.commission.holding import ROLES, Held, Holding, held
from ulna.live.commission.posture import Posture
from ulna.live.commission.standing import Stood, stood
from ulna.live.commission.turning import MOVED_TURNS, Turned, Way, travels, turned, way
from ulna.live.samples import Hello, Samples
from ulna.live.tables import MapTable

HOLD_S = 4.0
"""How long an arm is held still."""
REST_S = 2.0
"""A joint that rests so long has been turned: whoever changes their grip is quicker."""
LOOK_S = 0.1
"""How often that is looked at."""
REST_TURNS = 1.0 / 360.0
"""A hand that holds a joint moves it by less, in that time."""
_NOISES, _STEPS = 8.0, 4.0

Kind = Literal["hold", "turn", "posture", "way"]
Found = Holding | Turned | Stood | Way


@dataclass(frozen=True)
class Step:
    """What is to be done."""

    kind: Kind
    joint: int | None
    """From 0; None of what all joints do."""
    sentence: str
    lines: tuple[str, ...] = ()
    """More of it, a line each."""


class Commissioning:
    """Goes through the steps: `step` says what is to be done, `take` is given what comes until it says what was found,
    and `accept`, `again` or `skip` say what becomes of that."""

    def __init__(
        self,
        hello: Hello,
        joints: int,
        table: MapTable | None = None,
        *,
        ways: Sequence[str | None] = (),
        posture: Posture | None = None,
        wait_s: float = 30.0,
        hold_s: float = HOLD_S,
        rest_s: float = REST_S,
    ) -> None:
        """table: what is known of the channels; ways: of each joint, how it is turned so that it counts as positive, in
        words; None: nobody can say; posture: one that the arm is brought to, from which the ways are, in place of
        `ways`. wait_s: how long a joint is waited for; hold_s: how long the arm is held still; rest_s: a joint that
        rests so long has been turned.

        Raises UlnaInputError where there are fewer channels than joints, or channels that the source does not send.
        """
        table = MapTable() if table is None else table
        lacking = [name for name in table.channels or () if name not in hello.channels]
        if lacking:
            raise UlnaInputError(
                f"key 'map.channels': got '{lacking[0]}', which {hello.device} does not send; expected some of "
                f"{', '.join(hello.channels)}. Correct it."
            )
        names = tuple(table.channels or hello.channels)
        if len(names) < joints:
            raise UlnaInputError(
                f"{hello.device}: {len(names)} channels ({', '.join(names)}) for {joints} joints; expected one "
                "for each at least. Say how many joints there are with --joints."
            )
        counts = table.counts_per_turn or hello.counts_of(names)
        stated = None if counts is None else np.broadcast_to(np.asarray(counts, dtype=float), (len(names),)).copy()
        self.known = Known(names, table.unit or hello.unit, stated)
        self.joints = joints
        self.holding: Holding | None = None
        self.turned: dict[int, Turned] = {}
        self.stood: Stood | None = None
        self.posture = posture
        self.signs: dict[int, int] = {}
        self.endless: set[int] = set()
        """Joints of which somebody says that they turn on and on."""
        self._columns = [hello.channels.index(name) for name in names]
        self._ways = [*(ways if posture is None else posture.ways), *[None] * joints][:joints]
        self._wait_s, self._hold_s, self._rest_s = wait_s, hold_s, rest_s
        self._steps: list[tuple[Kind, int | None]] = [("hold", None), *(("turn", k) for k in range(joints))]
        if posture is not None:
            self._steps.append(("posture", None))
        # from the last joint on: what was turned beyond a joint leaves its axis where it was
        self._steps += [("way", k) for k in reversed(range(joints)) if self._ways[k] is not None]
        self._found: Found | None = None
        self._left: list[tuple[F64, F64]] = []
        self._begin()

    def _begin(self) -> None:
        self._t_s, self._raw = list[F64](), list[F64]()
        self._looked_s = -np.inf
        self._moved = False
        self._found = None

    @property
    def step(self) -> Step | None:
        """What is to be done now; None when all is done."""
        if not self._steps:
            return None
        kind, joint = self._steps[0]
        if kind == "hold":
            return Step(
                kind,
                joint,
                worded("Hold the arm still, or lay it down, for {seconds} s.", seconds=f"{self._hold_s:.0f}"),
            )
        if kind == "posture":
            assert self.posture is not None
            said = worded("Bring the arm into this posture, by eye, and let it rest there:")
            return Step(kind, joint, said, self.posture.words)
        assert joint is not None
        if kind == "turn":
            said = worded(
                "Turn only joint {joint} (from the base), to and fro, up to its stops. Then let it rest.",
                joint=joint + 1,
            )
            return Step(kind, joint, said)
        way = self._ways[joint]
        assert way is not None
        said = worded("Turn only joint {joint} {way}, by some 30°, and leave it there.", joint=joint + 1, way=way)
        return Step(kind, joint, said)

    @property
    def left(self) -> int:
        """Steps that are not done."""
        return len(self._steps)

    def take(self, samples: Samples) -> Found | None:
        """What came; what was found where the step is done by that. More is not looked at until somebody has said what
        becomes of it."""
        if len(samples):
            raw = samples.raw[:, self._columns]
            cuts = np.flatnonzero(np.diff(np.floor(samples.t_host_s / LOOK_S))) + 1
            self._left += zip(np.split(samples.t_host_s, cuts), np.split(raw, cuts), strict=True)
        while self._left and self._found is None and self._steps:
            t_s, raw = self._left.pop(0)
            self._t_s.append(t_s)
            self._raw.append(raw)
            self.known.see(raw)
            if t_s[-1] - self._looked_s >= LOOK_S:
                self._looked_s = float(t_s[-1])
                self._found = self._look()
        return self._found

    def forget(self) -> None:
        """What came meanwhile, while somebody was asked, belongs to no step."""
        self._left.clear()

    def accept(self) -> None:
        """What was found is so. Raises ValueError where nothing was."""
        found = self._found
        if found is None or found.why_not is not None:
            raise ValueError("nothing was found that can be accepted")
        match found:
            case Holding():
                self.holding = found
                self.known.joints &= np.array([each.role == "channel" for each in found.channels])
            case Turned():
                self.turned[found.joint] = found
            case Stood():
                self.stood = found
            case Way():
                self.signs[found.joint] = found.sign
        self._steps.pop(0)
        self._begin()

    def again(self) -> None:
        """The same step once more."""
        self._begin()

    def skip(self) -> None:
        """Not this joint; it stays unknown. Raises ValueError of holding still."""
        kind, joint = self._steps[0]
        if kind == "hold":
            raise ValueError("holding still cannot be skipped")
        if kind == "posture":  # ways are from there
            self._steps = [each for each in self._steps if each[0] == "turn"]
        else:
            self._steps = [each for each in self._steps if each[1] != joint or joint is None]
        self._begin()

    @property
    def bars(self) -> list[tuple[str, float, float]]:
        """Of each channel its name, the newest reading, and by how many degrees it moved in this step."""
        if not self._raw:
            return []
        raw = np.concatenate(self._raw)
        degrees = 360.0 * travels(raw, self.known)[1]
        return [(name, float(raw[-1, k]), float(degrees[k])) for k, name in enumerate(self.known.names)]

    def findings(self) -> Findings:
        """All of it. Raises UlnaInputError where a joint was not found."""
        lacking = [k for k in range(self.joints) if k not in self.turned]
        if lacking or self.holding is None:
            which = ", ".join(str(k + 1) for k in lacking)
            raise UlnaInputError(
                worded(
                    "joint {joints}: never turned, so that its channel is not known; expected every one of {all} "
                    "joints. Nothing was written. Turn it, or say how many joints there are with --joints.",
                    joints=which,
                    all=self.joints,
                )
            )
        channels = {each.name: each for each in self.holding.channels}
        joints = tuple(self._joint(k, channels) for k in range(self.joints))
        used = {joint.channel for joint in joints}
        unused = tuple(self._unused(each) for each in self.holding.channels if each.name not in used)
        unit, why, guessed = self.known.unit()
        return Findings(joints, unit, why, guessed, self.holding, unused)

    def _joint(self, joint: int, channels: dict[str, Held]) -> FoundJoint:
        turned, sign = self.turned[joint], self.signs.get(joint, 0)
        assert turned.channel is not None
        found = found_joint(turned, channels, self.known, sign, joint in self.endless)
        if self.stood is None or self.posture is None:
            return found
        at = self.stood.at[turned.channel], float(self.posture.turned_rad[joint])
        return replace(found, at_posture=at[0], turned_rad=at[1])

    def _unused(self, channel: Held) -> str:
        if channel.role != "channel":
            return worded("{name} is a {role}.", name=channel.name, role=ROLES[channel.role])
        if channel.constant:
            return worded("{name} never changed.", name=channel.name)
        return worded("{name} is no joint that was turned.", name=channel.name)

    def _look(self) -> Found | None:
        kind, joint = self._steps[0]
        t_s = np.concatenate(self._t_s)
        took_s = float(t_s[-1] - t_s[0])
        if kind == "hold":
            return held(t_s, np.concatenate(self._raw), self.known) if took_s >= self._hold_s else None
        raw = np.concatenate(self._raw)
        self._moved = self._moved or bool((travels(raw, self.known)[1] >= MOVED_TURNS).any())
        if not self._moved and took_s < self._wait_s:
            return None
        resting = t_s >= t_s[-1] - self._rest_s
        if self._moved and not (took_s >= self._rest_s and self._rests(raw[resting])):
            return None
        if kind == "posture":
            channels = {k: found.name for k, found in self.turned.items()}
            return stood(raw, self.known, int(resting.sum()), channels)
        assert joint is not None
        if kind == "turn":
            taken = {found.channel: each for each, found in self.turned.items() if found.channel is not None}
            return turned(joint, raw, self.known, taken)
        return way(self.turned[joint], raw, self.known)

    def _rests(self, raw: F64) -> bool:
        assert self.holding is not None
        noise = np.array([max(_NOISES * each.noise, _STEPS * (each.step or 0.0)) for each in self.holding.channels])
        return bool((travels(raw, self.known)[1] <= np.maximum(REST_TURNS, noise / self.known.turn)).all())
