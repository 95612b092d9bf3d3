"""A plan that was written, read again: from its folder, to try it or to check what was measured. mm and rad."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.kinds import made
from ulna.artefacts.tables import Place
from ulna.formats.models import fill_json
from ulna.formats.toml import check_format, read_json
from ulna.formats.units import Units
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError
from ulna.planning.result_file import WHAT, PlanResultFile
from ulna.planning.spec import PlanSpec
from ulna.planning.stands import Stand
from ulna.planning.within import Within

ARM, PLAN = "arm.toml", "plan.json"


@dataclass(frozen=True)
class Planned:
    """What a plan says."""

    path: Path
    """Of plan.json."""
    arm: Arm
    """The nominal arm that it was made for."""
    spec: PlanSpec
    stands: list[Stand]
    q_rad: F64
    """(N, K, t, n) postures of the measurements, in their order."""
    u_length_mm: float
    """What was promised: root mean square over the test lengths."""
    files: tuple[Path, ...]
    """What it was read from."""

    @property
    def probe(self) -> int:
        """Index of the probe that touches."""
        return self.arm.probe_index(self.spec.probe)

    @property
    def stand(self) -> I64:
        """(N,) index of each measurement's stand."""
        return np.repeat(np.arange(len(self.stands)), [len(stand.measurements) for stand in self.stands])

    @property
    def points_mm(self) -> F64:
        """(N, K, 3) where its touches are, base frame."""
        found: F64 = np.array([stand.points_mm for stand in self.stands])[self.stand]
        return found


def load_planned(path: Path) -> Planned:
    """From the folder that `ulna plan -o` wrote, or its plan.json. Raises UlnaInputError."""
    file = path / PLAN if path.is_dir() else path
    document, _ = read_json(file, WHAT)
    check_format(document, file, "ulna-plan-result")
    found = fill_json(PlanResultFile, document, file)
    arm = Arm.load(file.parent / ARM)
    asked = found.asked
    ((name, table),) = asked.artefact.items()
    place = Place(file, Units(length="mm", angle="rad"), [])
    artefact = made(name, table, place)
    spec = PlanSpec(
        artefact=artefact,
        encoder_rad=np.array(asked.encoder_rad),
        seat_mm=asked.seat_mm,
        choose=sum(len(stand.placements) for stand in found.places),
        touches=asked.touches,
        hold=list(asked.hold),
        probe=asked.probe,
        test_mm=asked.test_mm,
        travel_rad=None if asked.travel_rad is None else np.array(asked.travel_rad),
        volume_mm=asked.volume_mm,
        within=None if asked.within is None else Within(**asked.within.model_dump()),
        seed=asked.seed,
        label=str(file),
    )
    stands = [Stand(each.stand, np.array(each.points_mm), np.array(each.placements)) for each in found.places]
    q_rad = _postures(found, stands, arm, file)
    u_mm = found.planned.get("u_length_mm")
    if not isinstance(u_mm, float):
        raise UlnaInputError(f"{file}: key 'planned.u_length_mm': expected a number, in mm. Plan again.")
    return Planned(
        file, arm, spec, stands, q_rad, u_mm, (file, file.parent / ARM, *(each.path for each in place.files))
    )


def _postures(found: PlanResultFile, stands: list[Stand], arm: Arm, file: Path) -> F64:
    """(N, K, t, n); raises UlnaInputError where steps and stands do not belong together."""
    count, places = sum(len(stand.measurements) for stand in stands), len(stands[0].points_mm)
    keys = [f"q{k + 1}" for k in range(arm.n)]
    rows = [[(step.model_extra or {}).get(key) for key in keys] for step in found.steps]
    numbers = [number for stand in stands for number in stand.measurements.tolist()]
    per = len(rows) // count
    fits = (
        numbers == list(range(1, count + 1))
        and len(rows) == count * per
        and per % places == 0
        and all(stand.points_mm.shape == (places, 3) for stand in stands)
        and all(isinstance(value, float | int) for row in rows for value in row)
    )
    if not fits:
        raise UlnaInputError(
            f"{file}: stands and steps do not belong together, or to the {arm.n} joints of {file.parent / ARM}; "
            "expected them as ulna plan writes them. Plan again."
        )
    return np.array(rows, dtype=np.float64).reshape(count, places, per // places, arm.n)
