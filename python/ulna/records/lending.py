"""What a study asks of the record: an artefact's size by the certificate that is valid today."""

from __future__ import annotations

from collections.abc import Sequence

from ulna.artefacts.lent import Lent
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import recalled, templates, worded
from ulna.records import asked
from ulna.records.bench import Bench
from ulna.records.due import today

STATES = templates("quarantined", "retired", "in use")


def lent(name: str, quantities: Sequence[str], expired_because: str | None) -> Lent:
    """By the record that is found without being named: see `lent_by`."""
    return lent_by(Bench.open(), name, quantities, expired_because)


def lent_by(bench: Bench, name: str, quantities: Sequence[str], expired_because: str | None) -> Lent:
    """The first of the quantities that its certificate states. Raises UlnaInputError for what is not registered, not in
    use, has no such value, or none that is valid, unless a reason is given."""
    on = today()
    with bench.reading() as connection:
        row = asked.equipment(connection, name, ("artefact",))
        if row["state"] != "in use":
            raise UlnaInputError(
                worded(
                    "'{name}' is {state}; expected an artefact in use. Name another, or release it.",
                    name=name,
                    state=recalled(str(row["state"]), STATES),
                )
            )
        known = str(row["name"])
        found = [asked.certified(connection, known, quantity, on) for quantity in quantities]
    rows = [each for each in found if each is not None]
    if not rows:
        raise UlnaInputError(
            f"'{name}' has no certified {' or '.join(quantities)} from {on} or before; expected one. Enter it: ulna "
            "record "
            f'artefact {known!r} --value "{quantities[0]}=…±…".'
        )
    row = rows[0]
    if on <= (row["valid_to"] or "9999"):
        return _lent(known, row, "")
    if expired_because is None:
        raise UlnaInputError(
            worded(
                "the certificate of '{name}' was valid to {day}, and today is {today}; expected a valid one. Enter the "
                'new one, or say why this one is used: expired_because = "…".',
                name=name,
                day=row["valid_to"],
                today=on,
            )
        )
    return _lent(known, row, f"; NOT VALID on {on}, used because: {expired_because}")


def _lent(name: str, row: asked.Row, more: str) -> Lent:
    number = f"certificate {row['number']}" if row["number"] else "a certificate without a number"
    warm = "" if row["temperature_c"] is None else f" at {row['temperature_c']:g} °C"
    until = f", valid to {row['valid_to']}" if row["valid_to"] else ""
    value, u, unit = float(row["value"]), float(row["u"]), row["unit"]
    said = f"{row['quantity']} {value:.10g} {unit}, u {u:.3g} {unit}{warm}, by {number}{until}{more}."
    return Lent(name, str(row["quantity"]), value, u, said)
