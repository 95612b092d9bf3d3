"""What can be wrong with a stream, in words, with the time at which it was seen."""

from __future__ import annotations

from dataclasses import dataclass

GARBAGE = "garbage"
GAP = "gap"
REPEAT = "repeat"
CLOCK_JUMP = "clock_jump"
WRAP = "wrap"
RESET = "reset"
SWAP = "swap"
JUMP = "jump"
TOO_LONG = "too_long"
ENDED = "ended"
KINDS = {
    GARBAGE: "bytes that are no reading, skipped",
    GAP: "no reading for longer than there should be",
    REPEAT: "the same reading sent again",
    CLOCK_JUMP: "the device's clock went back, or ahead of time",
    WRAP: "an encoder, or the device's clock, began again after its last count; turns go on",
    RESET: "the device counts from zero again",
    SWAP: "two fields changed places",
    JUMP: "a joint moved faster than an arm does",
    TOO_LONG: "a line of more than 4 kB, or more than 32 channels: the source ends",
    ENDED: "the source ended",
}
"""Kind → what it is."""
DOUBTFUL = frozenset({RESET, SWAP, JUMP})
"""After these nothing says that the angles are still right: a stream is doubtful until somebody says so."""
ORDINARY = frozenset({WRAP})
"""What encoders do by their nature: kept and counted, and not said to somebody who has an arm in the hand."""


@dataclass(frozen=True)
class Fault:
    """One thing that was wrong; or how often it was, `more`."""

    kind: str
    """One of `KINDS`."""
    t_host_s: float
    """When it was seen, time.monotonic()."""
    text: str
    """One sentence."""
    more: int = 0
    """So many faults of this kind that were not told one by one; 0: this is one."""

    def as_dict(self) -> dict[str, object]:
        """As JSON has it."""
        found: dict[str, object] = {"kind": self.kind, "t_host_s": self.t_host_s, "text": self.text}
        return found | ({"more": self.more} if self.more else {})
