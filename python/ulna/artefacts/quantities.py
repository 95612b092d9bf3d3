"""What a metrologist reads from touches: the quantities, one row each, and how many single errors become figures.

* **seat scatter**, **length error**, **coordinate error**: see `ulna.artefacts.seats`; a length error is of length rows
  too, the distance between the two tips minus the stated one. Signed: positive is measured too long.
* **form**, **diameter error**: of touches of a surface, the spread of distances from the placement's least-squares
  surface (largest minus smallest), and its diameter, less the ball's, minus the calibrated one (signed; the largest in
  size over several placements). Placements touched too few times have none.
* **distance error**: of rows of an instrument, the distance of the tip from the point that fits the placement's
  readings best, minus the distance that the instrument's reading says. Signed as a length error is.
"""

from __future__ import annotations

from dataclasses import dataclass

_WORDS = {
    "mean": "mean",
    "mean_abs": "mean size",
    "rms": "rms",
    "max": "max",
    "max_abs": "max size",
    "largest": "largest",
}
_HEADS = {"mean": "\nmean", "mean_abs": "\nsize", "max": "\nmax", "max_abs": "\nmax", "largest": ""}


@dataclass(frozen=True)
class Quantity:
    """One quantity and its figures."""

    name: str
    figures: tuple[str, ...]
    """Of "mean" (of sizes; of a signed quantity the signed mean), "mean_abs", "rms", "max" (or "max_abs"), "largest":
    the single error that is largest in size, with its sign."""

    meaning: str
    """In a sentence, as the schemas of results have it."""
    label: str
    """As tables call it in a terminal."""
    short: str
    """The same in as few letters as the head of a column has room for."""

    @property
    def signed(self) -> bool:
        """Whether an error can be positive or negative, and has a mean."""
        return "mean_abs" in self.figures

    @property
    def distributed(self) -> bool:
        """Whether there are many errors, with a mean, an RMS and a largest; else only the largest is kept."""
        return "rms" in self.figures

    def figure(self, figure: str) -> str:
        """A figure as results call it: in mm."""
        return f"{self.name}_mm" if figure == "largest" else f"{self.name}_{figure}_mm"

    def names(self) -> list[str]:
        """Of its figures, as results call them."""
        return [self.figure(figure) for figure in self.figures]

    def words(self) -> dict[str, str]:
        """Of every figure, by its name."""
        signed = "signed " if self.signed else ""
        word = {**_WORDS, "mean": f"{signed}mean"}
        return {self.figure(figure): f"{self.label}, {word[figure]}" for figure in self.figures}

    def heads(self) -> dict[str, str]:
        """Of the figures that a table by placements shows, by name."""
        return {self.figure(figure): f"{self.short}{_HEADS[figure]}" for figure in self.figures if figure in _HEADS}


QUANTITIES = (
    Quantity(
        "seat_scatter",
        ("mean", "rms", "max"),
        "Distance of each touch to the mean of its own seat's touches.",
        "seat scatter",
        "seat",
    ),
    Quantity(
        "length_error",
        ("mean", "mean_abs", "rms", "max_abs"),
        "Distance between the means of two seats minus the calibrated length; the signed mean.",
        "length error",
        "length",
    ),
    Quantity(
        "coordinate_error",
        ("mean", "rms", "max"),
        "Distance to the reference coordinates after the best rigid fit.",
        "coordinate error",
        "coord.",
    ),
    Quantity(
        "form",
        ("largest",),
        "Spread of distances from the least-squares surface; the largest of all placements.",
        "form",
        "form",
    ),
    Quantity(
        "diameter_error",
        ("largest",),
        "Of the least-squares surface, signed; the largest in size of all placements.",
        "diameter error",
        "diam.\nerror",
    ),
    Quantity(
        "distance_error",
        ("mean", "mean_abs", "rms", "max_abs"),
        "Distance from the point that fits a placement's tips best minus the one measured; the signed mean.",
        "distance error",
        "dist.",
    ),
    Quantity(
        "orientation_error",
        ("mean", "rms", "max"),
        "Angle between the orientations that the arm and the instrument say, in mm at 1 m: mrad.",
        "orientation error",
        "orient.",
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
