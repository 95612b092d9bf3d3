"""Ask what readings can determine, before trusting any number fitted to them.

The same bars are measured with a straight probe, whose tip lies on the last axis, and with a bent one. The straight
probe cannot tell some parameters of joint 6 from its own length: a fit would still print numbers for them, and they
would mean nothing. `ulna.identify` names the combinations that are lost, and what would find them.

No noise and no measured length is needed for the question: only where the arm was.
"""

import ulna
from virtual_lengths import JOINTS, lengths_between_random_poses


def tell(words: str, probes: dict[str, ulna.Probe]) -> None:
    """Print what lengths with these probes determine."""
    arm = ulna.Arm("seven axes", JOINTS, probes)
    found = ulna.identify(lengths_between_random_poses(arm, rows=120, seed=1))
    print(f"{words}: {found.determined} of {found.parameters} determined, condition {found.condition:.1e}")
    for direction in found.lost:
        names = ", ".join(sorted(direction["combination"]))
        print(f"  lost: {names}\n    because {direction['because']}\n    remedy: {direction['remedy']}")


if __name__ == "__main__":
    tell("bent probe, tip 40 mm off the last axis", {"bent": ulna.Probe(40.0, 0.0, 200.0)})
    tell("straight probe", {"straight": ulna.Probe(0.0, 0.0, 200.0)})
