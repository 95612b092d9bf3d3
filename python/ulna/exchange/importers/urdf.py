"""A robot's description (URDF) as an arm file, with a comment on where the arm's base frame stands in it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.file import arm_toml
from ulna.arm.frames.rigid import to_rpy
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import Chain, read_chain
from ulna.formats.output import refuse_inputs, write_file
from ulna.ground.arrays import F64


@dataclass(frozen=True)
class Imported:
    """An arm, and how it stands to what it was made of."""

    arm: Arm
    chain: Chain
    t_root_base: F64
    """(4, 4), mm: the arm's base frame in that of the chain's first link."""

    @property
    def remark(self) -> str:
        """Where the base frame stands: the coordinates of every point depend on it, no length does."""
        return base_remark(self.t_root_base, f"of link '{self.chain.base_link}'")


def import_urdf(
    path: Path, out: Path, tip_link: str | None = None, base_link: str | None = None, force: bool = False
) -> Imported:
    """Write the arm file. Raises UlnaInputError; nothing is written then."""
    refuse_inputs([out], [path])
    chain = read_chain(path, tip_link, base_link)
    arm, t_root_base = arm_from_chain(chain)
    found = Imported(arm, chain, t_root_base)
    lines = [f"Made of {path.name}, from link '{chain.base_link}' to link '{chain.tip_link}'.", found.remark]
    write_file(out, commented(arm, lines), force=force)
    return found


def commented(arm: Arm, lines: list[str]) -> str:
    """An arm file with comments on top."""
    # names come from files of others: nothing in them may end the comment
    return "".join(f"# {''.join(c if c.isprintable() else '?' for c in line)}\n" for line in lines) + arm_toml(arm)


def base_remark(t: F64, whose: str) -> str:
    """In words: where the arm's base frame stands in a frame that is called `whose`."""
    if np.array_equal(t, np.eye(4)):
        return f"The arm's base frame is that {whose}."
    xyz = ", ".join(f"{value:.9g}" for value in t[:3, 3])
    rpy = ", ".join(f"{value:.9g}" for value in to_rpy(t[:3, :3]))
    return (
        f"The arm's base frame stands on axis 1. In that {whose} it is at xyz = {xyz} mm, turned by rpy = {rpy} rad; "
        "points are measured in the arm's."
    )
