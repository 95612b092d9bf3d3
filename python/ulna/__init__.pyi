"""Public names, and where each is; `__init__.py` loads them from here when they are first used."""

from .arm.arm import Arm
from .arm.effects.effects import Effects
from .arm.joint import Joint
from .arm.payload import Payload
from .arm.probe import Probe
from .artefacts.artefact import Artefact
from .artefacts.readings import Readings
from .calibration.batch import Batch, batch
from .calibration.calibrate import calibrate
from .calibration.cross_validate import CrossValidation, cross_validate
from .calibration.evaluate import Evaluation, evaluate
from .calibration.identify import identify
from .calibration.result import Result
from .checking.check import Check, check
from .comparison.compare import Comparison, compare
from .documents.certificate import certificate
from .documents.laboratory.issued import Issued
from .ground.errors import InputWarning, UlnaInputError
from .measuring.measure import measure
from .measuring.measured import Length, Measured
from .measuring.measurement import Measurement
from .planning.outcome import Plan
from .planning.plan import plan
from .planning.spec import PlanSpec
from .records.records import Records
from .simulation.simulate import Simulated, simulate
from .simulation.spec import Simulation
from .study.data import FitOptions, Noise, Prior
from .study.study import Study
from .uncertainties.assess import Assessment
from .uncertainties.uncertainty import uncertainty, volume_uncertainty
from .uncertainties.volume import VolumeMap
from .verification.verify import Verification, verify

__all__ = [
    "Arm",
    "Artefact",
    "Assessment",
    "Batch",
    "Check",
    "Comparison",
    "CrossValidation",
    "Effects",
    "Evaluation",
    "FitOptions",
    "InputWarning",
    "Issued",
    "Joint",
    "Length",
    "Measured",
    "Measurement",
    "Noise",
    "Payload",
    "Plan",
    "PlanSpec",
    "Prior",
    "Probe",
    "Readings",
    "Records",
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
    "certificate",
    "check",
    "compare",
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

__version__: str
