"""What an acceptance test says: templates of its sentences, by which one that was kept in a file is known again."""

from __future__ import annotations

from ulna.ground.worded import recalled, templates

COUNTED = "{what}: {found}; the profile counts {expected}."
COUNTED_EACH = "{what}: {found}; the profile counts {expected} of each."
COUNTED_SOME = "{what}: {found}, … ({count} in all); the profile counts {expected} of each."
EACH = "{count} of {name}"
AND_MORE = "{first}, {rest}"
WITHIN = (
    "{what} {name}: {length} mm, {share} % of the reach (half the range); the profile asks for {least} to {most} %."
)
LONGEST = "longest length: {length} mm, {share} % of the range; the profile asks for at least {least} %."
LONGEST_NOT_CHECKED = (
    "the measuring range is not stated (key 'range'): whether the longest length, {length} mm, is at least {least} % "
    "of it was not checked."
)
AWAY_NOT_CHECKED = "how far from the base the seats stood was not checked: coordinates may be in any frame."
SEATS_NOT_CHECKED = "the measuring range is not stated (key 'range'): how far out the seats stood was not checked."
BARS_NOT_CHECKED = "the measuring range is not stated (key 'range'): the lengths of the bars were not checked."
NOT_MEASURED = "test '{test}' ({figures}) was not measured."
OF_TEST = "{test}: {departure}"
TACTILE_ALONE = "Tactile probing alone was tested; of a scanner on the arm (ISO 10360-8) nothing is said."
NO_SCANNER = (
    "Not covered: the scanner ({scanner}). Tactile probing alone was tested; of the scanner (ISO 10360-8) nothing is "
    "said."
)
DECISION = (
    "Pass where |value| ≤ limit - g, fail where |value| > limit + g, else undecided; {guard}. u is the standard "
    "uncertainty of the test value, not of the arm."
)
GUARD_2017 = "g = {factor} u (ISO 14253-1:2017, 95 % probability of conformity; w = r U with r = {r})"
GUARD_U = "g = w = U = {k} u (as older editions of ISO 14253-1 have it)"
GUARD_RU = "g = w = r U with r = {r}, U = {k} u"
GUARD_SIMPLE = "g = w = 0 (simple acceptance, no guard band)"
NO_LIMIT = "no limit stated"
NO_UNCERTAINTY = "no uncertainty of the test value stated"
NOT_USED = "{file}: the arm is not used: its readings are coordinates."
COUNTS = templates(
    "seats",
    "touches of a seat",
    "orientations of the probe",
    "points in an orientation",
    "positions of the ball",
    "points on the ball",
    "measurements of the ball",
    "points of a measurement",
    "lengths",
    "positions of a length",
    "repeats in a position",
    "lengths measured",
    "bars",
    "seat",
    "bar",
)
"""What a profile counts."""
FIGURES = templates(
    "Effective diameter: deviation of the mean",
    "Effective diameter: largest deviation",
    "Effective diameter: standard deviation",
    "Single-point articulation: largest deviation",
    "Single-point articulation: 2·S",
    "Volumetric: largest deviation",
    "Volumetric: 2 standard deviations",
    "Volumetric: half the range",
    "Volumetric: 2·RMS",
    "FARO SPAT, {axis}",
)
"""What figures are called, where that is more than a symbol."""
FORMULAS = templates(
    "D_fit - D_cal, signed; D_fit: diameter of the unconstrained least-squares sphere of the probe-centre "
    "points of one ball, less the diameter of the tip (of a hollow: more)",
    "R_max - R_min: largest minus smallest distance of a point from the centre of the same sphere",
    "diameter of the smallest sphere that holds the centres of the least-squares spheres, one centre for each "
    "orientation of the probe on one ball",
    "L - L_cal, signed: length measured from the same direction, or centre to centre, minus the calibrated length",
    "L - L_cal, signed: length measured from opposing directions, the diameter of the tip taken off, minus the"
    " calibrated length",
    "mean(D_i) - D_cal, signed; D_i: diameter of the least-squares sphere of one measurement of the ball, less"
    " the diameter of the tip",
    "the D_i - D_cal of the largest size, signed",
    "√(Σ(D_i - mean(D))² / (n - 1))",
    "max δ_i, δ_i = ‖p_i - mean(p)‖, over the touches of one seat",
    "2 √(Σδ_i² / (n - 1)), δ_i = ‖p_i - mean(p)‖, over the n touches of one seat",
    "the L_i - L_cal,i of the largest size, signed, over the ball bar's positions",
    "2 √(Σ(e_i - mean(e))² / (n - 1)), e_i = L_i - L_cal,i",
    "(max e_i - min e_i) / 2, e_i = L_i - L_cal,i",
    "2 √(Σe_i² / n), e_i = L_i - L_cal,i: other than 2 standard deviations, it holds the mean error",
    "(max {axis} - min {axis}) / 2 over the touches of one seat; it depends on the directions of the axes",
)
"""How they are computed."""
MANNERS = templates(
    "Evaluated in the manner of ISO 10360-12:2016, from secondary sources; counts are those of the profile. No "
    "statement that the text of the standard was followed.",
    "Evaluated in the manner of VDI/VDE 2617-9, taken to be that of ISO 10360-12:2016, from secondary sources; counts "
    "are those of the profile. No statement that the text of either was followed.",
    "Evaluated in the manner of ASME B89.4.22-2004, from secondary sources; counts are those of the profile. No "
    "statement that the text of the standard was followed.",
    "A short test, to be tried; counts are of no standard.",
)
"""Of the profiles that come with Ulna, and of the one that a virtual arm is tried with."""
VERDICTS = templates("pass", "fail", "undecided")
"""Of a value against its limit."""
SENTENCES = templates(
    COUNTED_SOME,
    COUNTED_EACH,
    COUNTED,
    WITHIN,
    LONGEST,
    LONGEST_NOT_CHECKED,
    AWAY_NOT_CHECKED,
    SEATS_NOT_CHECKED,
    BARS_NOT_CHECKED,
    NOT_MEASURED,
    NOT_USED,
    TACTILE_ALONE,
    NO_SCANNER,
    DECISION,
    GUARD_2017,
    GUARD_U,
    GUARD_RU,
    GUARD_SIMPLE,
    NO_LIMIT,
    NO_UNCERTAINTY,
    *MANNERS,
    *COUNTS,
)
"""All of them; of two that fit a sentence the first is the narrower."""


def said_of(text: str) -> str:
    """A sentence of a file with what it is made of; as it came where it is none of these."""
    return recalled(text, SENTENCES)


def said_of_check(text: str) -> str:
    """The same of a check, whose departures say first of which test they are."""
    found = said_of(text)
    return recalled(text, (OF_TEST, *SENTENCES)) if found is text else found
