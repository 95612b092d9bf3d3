"""What could be imported before the rooms were slices can be still, and says where it is now."""

from __future__ import annotations

import importlib
import subprocess
import sys
from collections.abc import Iterator

import pytest

import ulna
from ulna.ground.renamed import RENAMED, SPREAD

#: what the reference named before the move: module → names
DOCUMENTED = {
    "calibrate": ["calibrate"],
    "identify": ["identify", "Identification"],
    "evaluate": ["evaluate", "Evaluation"],
    "measure": ["measure", "Measurement"],
    "uncertainty": ["uncertainty"],
    "uncertainty.asking": ["uncertainty"],
    "uncertainty.assess": ["Assessment", "Value"],
    "uncertainty.monte_carlo": ["MonteCarlo"],
    "batch": ["batch", "Batch"],
    "cross_validate": ["cross_validate", "CrossValidation", "GroupFigures"],
    "simulate": ["simulate", "Simulated", "Truth", "TrueTouching"],
    "verification.planning": ["make_test_plan", "play_test_plan"],
    "model": ["Arm", "Joint", "Probe", "ParameterCovariance"],
    "effects": ["Effects"],
    "study": ["Study", "Artefact", "Readings", "Noise", "FitOptions", "Prior", "InputFile"],
    "simulation": ["Simulation", "Touching", "Drawing", "Temperature", "Missed"],
    "plan_spec": ["PlanSpec"],
    "result": ["Result", "Parameter", "FitSummary"],
    "extras": ["JudgedExtra"],
    "probes": ["ProbeView"],
    "figures": ["PlacementFigures", "figures"],
    "importers.urdf": ["import_urdf"],
    "importers.dh": ["import_dh"],
    "export.urdf": ["urdf_text"],
    "export.template": ["export_template"],
    "export.dh": ["dh_table"],
    "certificate.dcc.document": ["dcc_certificate", "Certificate"],
    "certificate.stated": ["StatedParameters"],
    "files.laboratory": ["load_laboratory", "Laboratory"],
    "errors": ["UlnaInputError", "InputWarning"],
    "document.gather": ["gather"],
    "document.content": ["Content"],
    "document.html.page": ["render"],
}


@pytest.fixture(autouse=True)
def _no_old_module_stays() -> Iterator[None]:
    """`import ulna.calibrate` puts a module in the place of a function: not for the tests that follow."""
    yield
    for name in RENAMED:
        sys.modules.pop(f"ulna.{name}", None)
        if name in ulna.__all__:
            vars(ulna).pop(name, None)


def test_the_table_has_all_that_was_documented_and_nothing_else() -> None:
    parents = {name.rsplit(".", 1)[0] for name in DOCUMENTED if "." in name} - {"verification", "uncertainty"}
    parents |= {name.rsplit(".", 1)[0] for name in parents if "." in name}
    assert {*RENAMED, *SPREAD} == {*DOCUMENTED, *parents}


@pytest.mark.parametrize("module", DOCUMENTED)
def test_an_old_name_is_the_same_object_and_says_where_it_is(module: str) -> None:
    for name in DOCUMENTED[module]:
        with pytest.warns(DeprecationWarning, match=rf"ulna\.{module}\.{name} is ulna\.[a-z_.]+\.{name} now") as told:
            found = getattr(importlib.import_module(f"ulna.{module}"), name)
        new = str(told[0].message).split(" is ")[1].split(" now")[0]
        place, _, attribute = new.rpartition(".")
        assert found is getattr(importlib.import_module(place), attribute)


def test_names_that_never_were_are_errors() -> None:
    with pytest.raises(ImportError):
        importlib.import_module("ulna.modell")
    with pytest.raises(AttributeError, match=r"'ulna\.model' has no attribute 'Leg'"):
        _ = importlib.import_module("ulna.model").Leg
    with pytest.raises(AttributeError):
        _ = ulna.nothing


def test_a_module_in_the_place_of_a_function_does_what_the_function_does() -> None:
    # in a process of its own: the module stays in that place
    code = (
        "import warnings; warnings.simplefilter('ignore')\n"
        "import ulna.calibrate\n"
        "try:\n    ulna.calibrate(None, nothing=1)\n"
        "except TypeError as error:\n    print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "got None, expected a study" in done.stdout


def test_the_public_names_are_those_of_the_list() -> None:
    assert sorted(dir(ulna)) == sorted(ulna.__all__)
    for name in ulna.__all__:
        assert getattr(ulna, name) is not None


def test_importing_ulna_loads_nothing_else() -> None:
    heavy = ("numpy", "polars", "pydantic", "pathlib")
    code = f"import sys, ulna; print([name for name in sys.modules if name.split('.')[0] in {heavy}])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
