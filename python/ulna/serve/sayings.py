"""Sentences that several places of the server say."""

from __future__ import annotations

from ulna.ground.worded import recalled, templates, worded

ENDINGS = templates(
    "converged-cost",
    "converged-step",
    "exact",
    "nothing-to-fit",
    "no-progress",
    "max-iterations",
    "held-poor",
    "poor-minimum",
    "off-scale",
)
"""How a fit ends: the core's names."""


def ending(name: str) -> str:
    """How a fit ended, in words that a page can translate."""
    return recalled(name, ENDINGS)


def not_converged(name: str) -> str:
    """Of a fit that ended otherwise."""
    return worded("The fit did not converge ({ending}): do not use these numbers.", ending=ending(name))


def fault(error: Exception) -> str:
    """What nobody foresaw."""
    return worded(
        "This is a fault of Ulna's, please report it: {kind}: {what}", kind=type(error).__name__, what=str(error)
    )
