"""What the tests of certificates share: results and laboratory files, as they are and as users may have them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ulna.documents.dcc.document import dcc_certificate

HERE = Path(__file__).resolve().parent
FOSSILS = HERE / "data" / "fossils"
RESULT = FOSSILS / "result-1.json"
EXAMPLE = HERE.parent / "examples" / "platinum" / "laboratory.toml"
EVERY_KEY = FOSSILS / "lab-1.toml"

MINIMAL = """format = "ulna-lab/1"
languages = ["en"]
[certificate]
identifier = "1"
country = "DE"
begin = 2026-01-01
end = 2026-01-01
location = "other"
[laboratory]
name = "L"
address = { country = "DE", city = "B" }
[[person]]
name = "P"
role = "R"
main_signer = true
[customer]
name = "C"
address = { country = "DE", city = "B" }
[item]
name = "Arm"
manufacturer = "M"
model = "T"
serial = "1"
[environment]
temperature = { low = 19, high = 21, unit = "°C" }
"""

#: what a probe may be called: fewer characters than elsewhere
PROBE = "<script>'&' \u202eمرحبا\u202c {x} %20"
NASTY = "<script>alert(\"1\")</script> & ]]> 'x' \u202eمرحبا\u202c {braces} %20"


def document() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(RESULT.read_text(encoding="utf-8"))
    return found


def without_noise(result: dict[str, Any]) -> None:
    result["provenance"]["noise"] = None


def without_freedom(result: dict[str, Any]) -> None:
    without_noise(result)
    result["fit"]["degrees_of_freedom"] = 0
    for row in result["parameters"]:
        row["u"] = None
    size = len(result["covariance"]["names"])
    result["covariance"]["matrix"] = [[None] * size] * size


def beyond_geometry(result: dict[str, Any]) -> None:
    """Expansions and compliances as if they had been fitted: the other units."""
    result["arm"]["joint"][0]["expansion"] = 1.1e-5
    result["arm"]["joint"][1] |= {"compliance": 2e-6, "mass": 4.5, "centre": [1.0, -2.0, 30.0]}
    size = len(result["covariance"]["names"])
    fitted = {"joint.1.expansion": (1.1e-5, 2e-6), "joint.2.compliance": (2e-6, 1e-7)}
    for what, unit in (("expansion", "1/K"), ("compliance", "rad/(N m)")):
        for number in range(1, len(result["arm"]["joint"]) + 1):
            name = f"joint.{number}.{what}"
            value, u = fitted.get(name, (0.0, None))
            row = {"name": name, "unit": unit, "start": 0.0, "value": value, "u": u}
            result["parameters"].append(row | {"status": "held" if u is None else "fitted"})
            if u is None:
                continue
            result["covariance"]["names"].append(name)
            for each in result["covariance"]["matrix"]:
                each.append(0.0)
            result["covariance"]["matrix"].append([0.0] * size + [u * u])
            size += 1


def nasty(result: dict[str, Any]) -> None:
    """Names that a study may have, in every place where names stand."""
    result["arm"]["name"] = NASTY
    text = json.dumps(result).replace("probe.bent.", json.dumps("probe." + PROBE + ".")[1:-1])
    result.update(json.loads(text))
    result["arm"]["probe"] = {PROBE if name == "bent" else name: tip for name, tip in result["arm"]["probe"].items()}
    result["provenance"]["files"][0]["path"] = f"folder/{NASTY.replace('/', '')}.toml"
    result["outliers"] = [
        {
            "row": 3,
            "file": NASTY,
            "artefact": NASTY,
            "placement": NASTY,
            "probe": NASTY,
            "norm_mm": 0.25,
            "times_scatter": 7.5,
        }
    ]


RESULTS: dict[str, Callable[[dict[str, Any]], None]] = {
    "as it is": lambda result: None,
    "without noise": without_noise,
    "without freedom": without_freedom,
    "beyond geometry": beyond_geometry,
    "nasty names": nasty,
}
LABORATORIES: dict[str, Callable[[], str]] = {
    "minimal": lambda: MINIMAL,
    "the example": lambda: EXAMPLE.read_text(encoding="utf-8"),
    "German alone": lambda: MINIMAL.replace('["en"]', '["de"]'),
    "French": lambda: MINIMAL.replace('["en"]', '["fr"]'),
    "French and English": lambda: MINIMAL.replace('["en"]', '["fr", "en"]'),
    "nasty": lambda: MINIMAL.replace('name = "Arm"', f"name = '''{NASTY}'''").replace(
        'serial = "1"', f"serial = '''{NASTY}'''\ndescription = '''{NASTY}\nsecond line'''"
    ),
}


def make(
    folder: Path, change: Callable[[dict[str, Any]], Any] = RESULTS["as it is"], laboratory: str = MINIMAL
) -> bytes:
    """The certificate of a changed fossil and a laboratory file's text."""
    result = document()
    change(result)
    (folder / "result.json").write_text(json.dumps(result), encoding="utf-8")
    (folder / "lab.toml").write_text(laboratory, encoding="utf-8")
    return dcc_certificate(folder / "result.json", folder / "lab.toml").content
