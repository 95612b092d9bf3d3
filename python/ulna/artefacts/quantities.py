"""What a metrologist reads from touches: the quantities, one row each, and how many single errors become figures.

* **seat scatter**, **length error**, **coordinate error**: see `ulna.artefacts.seats`; a length error is of length rows
  too, the distance between the two tips minus the stated one. Signed: positive is measured too long.
* **form**, **diameter error**: of touches of a surface, the spread of distances from the placement's least-squares
  surface (largest minus smallest), and its diameter, less the ball's, minus the calibrated one (signed; the largest in
  size over several placements). Placements touched too few times have none.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """One quantity and its figures."""

    name: str
    figures: tuple[str, ...]
    """Of "mean" (of sizes; of a signed quantity the signed mean), "mean_abs", "rms", "max" (or "max_abs"), "largest":
    the single error that is largest in size, with its sign."""

    meaning: str
    """In a sentence, as the schemas of results have it."""

    def names(self) -> list[str]:
        """Of its figures, as results call them: in mm."""
        return [f"{self.name}_mm" if figure == "largest" else f"{self.name}_{figure}_mm" for figure in self.figures]


QUANTITIES = (
    Quantity("seat_scatter", ("mean", "rms", "max"), "Distance of each touch to the mean of its own seat's touches."),
    Quantity(
        "length_error",
        ("mean", "mean_abs", "rms", "max_abs"),
        "Distance between the means of two seats minus the calibrated length; the signed mean.",
    ),
    Quantity(
        "coordinate_error", ("mean", "rms", "max"), "Distance to the reference coordinates after the best rigid fit."
    ),
    Quantity(
        "form",
        ("largest",),
        "Spread of distances from the least-squares sphere or plane; the largest of all placements.",
    ),
    Quantity(
        "diameter_error", ("largest",), "Of the least-squares sphere, signed; the largest in size of all placements."
    ),
)
"""In the order in which they are shown."""

NAMES = tuple(name for quantity in QUANTITIES for name in quantity.names())
"""Every figure, in the order in which it is shown. A figure that the readings do not give is left out, never 0."""

MEANINGS = {
    name: quantity.meaning if number == 0 else None
    for quantity in QUANTITIES
    for number, name in enumerate(quantity.names())
}
"""Of every figure, in their order: what it is, where its quantity begins."""
