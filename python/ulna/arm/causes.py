"""Why readings leave something open, and what to do: the sentences of the core, which come from it as plain strings.

The core (crates/ulna/src/identify/causes.rs, and what each effect says of itself) knows what it says; here stands what
it can say, so that it is said in other languages too. tests/contract/test_causes.py compares both.
"""

from __future__ import annotations

from ulna.ground.worded import recalled, templates

SENTENCES = templates(
    "no reading was taken with probe {probe}",
    "take readings with probe {probe} (32 poses in one seat are enough once the arm is known), or hold probe.{probe}.*",
    "joint {joint} was never moved in these readings",
    "take readings with joint {joint} turned over its whole travel, or hold these parameters",
    "it moves the tip, but not in anything that was read: the poses are too few or too much alike",
    "take readings at other places and directions, every joint turned over its travel; or hold these parameters",
    "it only moves the base frame: the readings see the arm from nowhere but itself",
    'none is needed, no length depends on it; coordinates of features in the base frame (frame = "arm") would fix it',
    "it only scales the arm: no length is known in these readings",
    "add readings of a bar of known length, or hold one known length of the arm",
    "only orientations were read: they tell no length of the arm",
    "add readings of places: points of the same tracker, a bar, a seat; or hold the lengths",
    "the link of joint {joint} and the tip are one rigid body: both say where the tip is, twice over",
    "none is needed, no point depends on it; without full_last_link the tip says it all, or hold joint.{joint}.*",
    "the tip lies on the last axis: turning the last joint moves nothing, so the direction of that axis cannot be seen",
    "measure with a probe at least 10 mm off the last axis, or with a second straight probe of another length",
    "the axes of joints {joint} and {next} are parallel: an offset along one is an offset along the other",
    'write joint {joint} with model = "hayati" (beta instead of d)',
    "joint {joint} slides: of such an axis only the direction matters, and where it lies is said by the links beside "
    "it as well",
    "none is needed, no point depends on it; or hold one of these parameters",
    "gravity makes no moment about the axis of joint {joint}: it is upright, or carries no stated mass",
    "hold joint.{joint}.compliance: nothing depends on it while the arm stands so",
    "joint 1 was approached from one side alone wherever the artefact stood: what its backlash does looks like the "
    "artefact turned about the first axis",
    "take readings with joint 1 approached from both sides while the artefact stands still (at the two ends of a "
    "length), or hold joint.1.backlash",
    "the readings do not say from which side joint {joint} was approached",
    "state with each reading how joint {joint} was approached (+1 where its encoder angle had been rising, -1 where it "
    "had been falling), or hold joint.{joint}.backlash",
    "joint {joint} was always approached from the same side: its backlash cannot be told from a shift of its zero",
    "take readings with joint {joint} approached from both sides, or hold joint.{joint}.backlash",
    "the temperature was the same in all readings: a warmer link cannot be told from a longer one",
    "take readings at other temperatures, or hold joint.*.expansion (at the material's, in the arm file)",
)
"""Causes, as the end of a sentence, and remedies."""


def said_of(text: str) -> str:
    """A cause or a remedy of the core, with what it is made of; as it came where it is none of these."""
    return recalled(text, SENTENCES)
