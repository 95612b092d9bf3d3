"""Ulna: calibration of articulated measuring arms.

    import ulna
    study = ulna.Study.load("study.toml")
    result = ulna.calibrate(study)
    result.save("out")

Names are loaded when they are first used, so that `import ulna` and `ulna --help` stay quick.
"""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from ulna.batch import Batch, batch
    from ulna.calibrate import calibrate
    from ulna.cross_validate import CrossValidation, cross_validate
    from ulna.effects import Effects
    from ulna.errors import InputWarning, UlnaInputError
    from ulna.evaluate import Evaluation, evaluate
    from ulna.identify import identify
    from ulna.measure import measure
    from ulna.model import Arm, Joint, Probe
    from ulna.plan_spec import PlanSpec
    from ulna.planning.plan import Plan, plan
    from ulna.result import Result
    from ulna.simulate import Simulated, simulate
    from ulna.simulation import Simulation
    from ulna.study import Artefact, FitOptions, Noise, Prior, Readings, Study
    from ulna.uncertainty.asking import uncertainty, volume_uncertainty
    from ulna.uncertainty.assess import Assessment
    from ulna.uncertainty.volume import VolumeMap
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
    "Arm": "model",
    "Artefact": "study",
    "Assessment": "uncertainty.assess",
    "Batch": "batch",
    "CrossValidation": "cross_validate",
    "Effects": "effects",
    "Evaluation": "evaluate",
    "FitOptions": "study",
    "InputWarning": "errors",
    "Joint": "model",
    "Noise": "study",
    "Plan": "planning.plan",
    "PlanSpec": "plan_spec",
    "Prior": "study",
    "Probe": "model",
    "Readings": "study",
    "Result": "result",
    "Simulated": "simulate",
    "Simulation": "simulation",
    "Study": "study",
    "UlnaInputError": "errors",
    "VolumeMap": "uncertainty.volume",
    "Verification": "verification.verify",
    "batch": "batch",
    "calibrate": "calibrate",
    "cross_validate": "cross_validate",
    "evaluate": "evaluate",
    "identify": "identify",
    "measure": "measure",
    "plan": "planning.plan",
    "simulate": "simulate",
    "uncertainty": "uncertainty.asking",
    "volume_uncertainty": "uncertainty.asking",
    "verify": "verification.verify",
}


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module 'ulna' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"ulna.{_WHERE[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__


class _Package(ModuleType):
    """`ulna.calibrate` is the function, also after the module `ulna.calibrate` was imported by somebody else."""

    def __setattr__(self, name: str, value: Any) -> None:
        if not (name in _WHERE and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
