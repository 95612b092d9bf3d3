"""Ulna: calibration of articulated measuring arms.

    import ulna
    study = ulna.Study.load("study.toml")
    result = ulna.calibrate(study)
    result.save("out")

Names are loaded when they are first used, so that `import ulna` and `ulna --help` stay quick.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from ulna.ground.version import VERSION

__version__ = VERSION

if TYPE_CHECKING:
    from ulna.arm.arm import Arm
    from ulna.arm.effects.effects import Effects
    from ulna.arm.joint import Joint
    from ulna.arm.probe import Probe
    from ulna.artefacts.artefact import Artefact
    from ulna.artefacts.readings import Readings
    from ulna.calibration.batch import Batch, batch
    from ulna.calibration.calibrate import calibrate
    from ulna.calibration.cross_validate import CrossValidation, cross_validate
    from ulna.calibration.evaluate import Evaluation, evaluate
    from ulna.calibration.identify import identify
    from ulna.calibration.result import Result
    from ulna.ground.errors import InputWarning, UlnaInputError
    from ulna.measuring.measure import measure
    from ulna.planning.outcome import Plan
    from ulna.planning.plan import plan
    from ulna.planning.spec import PlanSpec
    from ulna.simulation.simulate import Simulated, simulate
    from ulna.simulation.spec import Simulation
    from ulna.study.data import FitOptions, Noise, Prior
    from ulna.study.study import Study
    from ulna.uncertainties.assess import Assessment
    from ulna.uncertainties.uncertainty import uncertainty, volume_uncertainty
    from ulna.uncertainties.volume import VolumeMap
    from ulna.verification.verify import Verification, verify

__all__ = [
    "Arm",
    "Artefact",
    "Assessment",
    "Batch",
    "CrossValidation",
    "Effects",
    "Evaluation",
    "FitOptions",
    "InputWarning",
    "Joint",
    "Noise",
    "Plan",
    "PlanSpec",
    "Prior",
    "Probe",
    "Readings",
    "Result",
    "Simulated",
    "Simulation",
    "Study",
    "UlnaInputError",
    "Verification",
    "VolumeMap",
    "__version__",
    "batch",
    "calibrate",
    "cross_validate",
    "evaluate",
    "identify",
    "measure",
    "plan",
    "simulate",
    "uncertainty",
    "verify",
    "volume_uncertainty",
]

_WHERE = {
    "Arm": "arm.arm",
    "Artefact": "artefacts.artefact",
    "Assessment": "uncertainties.assess",
    "Batch": "calibration.batch",
    "CrossValidation": "calibration.cross_validate",
    "Effects": "arm.effects.effects",
    "Evaluation": "calibration.evaluate",
    "FitOptions": "study.data",
    "InputWarning": "ground.errors",
    "Joint": "arm.joint",
    "Noise": "study.data",
    "Plan": "planning.outcome",
    "PlanSpec": "planning.spec",
    "Prior": "study.data",
    "Probe": "arm.probe",
    "Readings": "artefacts.readings",
    "Result": "calibration.result",
    "Simulated": "simulation.simulate",
    "Simulation": "simulation.spec",
    "Study": "study.study",
    "UlnaInputError": "ground.errors",
    "Verification": "verification.verify",
    "VolumeMap": "uncertainties.volume",
    "batch": "calibration.batch",
    "calibrate": "calibration.calibrate",
    "cross_validate": "calibration.cross_validate",
    "evaluate": "calibration.evaluate",
    "identify": "calibration.identify",
    "measure": "measuring.measure",
    "plan": "planning.plan",
    "simulate": "simulation.simulate",
    "uncertainty": "uncertainties.uncertainty",
    "verify": "verification.verify",
    "volume_uncertainty": "uncertainties.uncertainty",
}


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module 'ulna' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"ulna.{_WHERE[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
