"""The acts, one row each."""

from __future__ import annotations

from ulna.ground.errors import UlnaInputError, nearest
from ulna.records.acts import certified, equipment, event, filed, interval, issued, person, setting, standing
from ulna.records.acts.act import Act

ACTS: dict[str, Act] = {
    module.ACT.name: module.ACT
    for module in (filed, equipment, certified, event, person, setting, issued, standing, interval)
}


def act_of(name: str) -> Act:
    """By name. Raises UlnaInputError for one of a later Ulna, or a damaged record."""
    if name not in ACTS:
        raise UlnaInputError(f"record: an entry of act '{name}', which this Ulna does not know.{nearest(name, ACTS)}")
    return ACTS[name]
