"""Modules that were public under another name: they can still be imported, with a DeprecationWarning that says where
their contents stand now."""

from __future__ import annotations

import importlib
import importlib.machinery
import sys
import warnings
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Any

RENAMED: dict[str, tuple[str, ...]] = {
    "batch": ("calibration.batch",),
    "calibrate": ("calibration.calibrate",),
    "certificate": (),
    "certificate.dcc": (),
    "certificate.dcc.document": ("documents.dcc.document",),
    "certificate.stated": ("documents.certified.parameters",),
    "cross_validate": ("calibration.cross_validate", "calibration.summary"),
    "document": (),
    "document.content": ("documents.content.content",),
    "document.gather": ("documents.gather",),
    "document.html": (),
    "document.html.page": ("documents.html.page",),
    "effects": ("arm.effects.effects",),
    "errors": ("ground.errors",),
    "evaluate": ("calibration.evaluate",),
    "export": (),
    "export.dh": ("exchange.export.dh",),
    "export.template": ("exchange.export.template",),
    "export.urdf": ("exchange.export.urdf",),
    "extras": ("calibration.extras",),
    "figures": ("calibration.figures", "calibration.placements"),
    "files": (),
    "files.laboratory": ("documents.laboratory.file",),
    "identify": ("calibration.identify",),
    "importers": (),
    "importers.dh": ("exchange.importers.dh",),
    "importers.urdf": ("exchange.importers.urdf",),
    "measure": ("measuring.measure",),
    "model": ("arm.arm", "arm.joint", "arm.probe", "arm.covariance"),
    "plan_spec": ("planning.spec",),
    "probes": ("arm.probes",),
    "result": ("calibration.result", "calibration.summary"),
    "simulate": ("simulation.simulate", "simulation.truth"),
    "uncertainty": ("uncertainties.uncertainty",),
    "uncertainty.asking": ("uncertainties.uncertainty",),
    "uncertainty.assess": ("uncertainties.assess",),
    "uncertainty.monte_carlo": ("uncertainties.monte_carlo",),
    "verification.planning": ("verification.test_plan",),
}
"""Old module → modules that have its names now; both without `ulna.`."""

SPREAD: dict[str, tuple[str, ...]] = {
    "study": ("study.study", "study.data", "artefacts.artefact", "artefacts.readings"),
    "simulation": ("simulation.spec",),
}
"""Modules that are packages now: where the names are that they had."""


class _Renamed(ModuleType):
    """A module of that name, empty until it is asked for something."""

    def __init__(self, name: str, places: Sequence[str]) -> None:
        super().__init__(f"ulna.{name}")
        self.__path__: list[str] = []  # others may have stood in it
        self.__dict__["__getattr__"] = finder(name, places)

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        """`import ulna.calibrate` puts this in the place of the function `ulna.calibrate`, as it always did."""
        return getattr(self, self.__name__.rsplit(".", 1)[1])(*args, **kwargs)


def finder(name: str, places: Sequence[str]) -> Callable[[str], Any]:
    """A module's `__getattr__` that finds names in other modules, and says where it found them."""

    def find(attribute: str) -> Any:
        for place in () if attribute.startswith("__") else places:
            module = importlib.import_module(f"ulna.{place}")
            if hasattr(module, attribute):
                value = getattr(module, attribute)
                now = getattr(value, "__module__", module.__name__)
                warnings.warn(
                    f"ulna.{name}.{attribute} is {now}.{attribute} now; most names are in 'ulna' itself.",
                    DeprecationWarning,
                    stacklevel=2,
                )
                return value
        raise AttributeError(f"module 'ulna.{name}' has no attribute {attribute!r}")

    return find


class _Finder:
    """Finds and loads; asked last, for what is nowhere else. `importlib.abc`, whose kind it is, is slow to load."""

    def find_spec(
        self, fullname: str, path: Any = None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        if fullname.startswith("ulna.") and fullname.removeprefix("ulna.") in RENAMED:
            return importlib.machinery.ModuleSpec(fullname, self, is_package=True)  # type: ignore[arg-type]  # a loader by its methods
        return None

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType:
        name = spec.name.removeprefix("ulna.")
        return _Renamed(name, RENAMED[name])

    def exec_module(self, module: ModuleType) -> None:
        pass


def install() -> None:
    """Let old names be imported. Costs nothing until one is."""
    if not any(isinstance(known, _Finder) for known in sys.meta_path):
        sys.meta_path.append(_Finder())
