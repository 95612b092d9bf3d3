"""The whole certificate: a result and a laboratory file → XML."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lxml import etree

from ulna.calibration.result import Result
from ulna.documents.certified.parameters import StatedParameters
from ulna.documents.certified.source import certified_result
from ulna.documents.certified.test_values import StatedTests
from ulna.documents.certified.verification import stated_tests
from ulna.documents.dcc import results
from ulna.documents.dcc.acceptance import conformity_statements, tests_result
from ulna.documents.dcc.administrative import administrative_data, software
from ulna.documents.dcc.conditions import calibration_method, input_files, laboratory_conditions, laboratory_methods
from ulna.documents.dcc.sheet import DCC, NAMES, Element, Sheet
from ulna.documents.dcc.statements import statements
from ulna.documents.laboratory.file import Laboratory, load_laboratory
from ulna.documents.laboratory.issued import Issued
from ulna.documents.laboratory.tables import LaboratoryFile
from ulna.documents.sources.result import result_file

VERSION = "3.3.0"
_XSI = "http://www.w3.org/2001/XMLSchema-instance"


@dataclass(frozen=True)
class Certificate:
    """A digital calibration certificate that nobody has signed yet."""

    content: bytes
    """XML in UTF-8, the same for the same files."""
    identifier: str
    """As the laboratory file has it."""
    stated: StatedParameters
    tested: list[StatedTests]
    missing: list[str]
    """What the laboratory file could have said and did not."""
    issued: bool = False
    """Whether it is said to be issued; a draft else."""

    def as_dict(self) -> dict[str, Any]:
        """What it holds, in numbers: JSON types only."""
        stated = self.stated
        return {
            "format": f"DCC {VERSION}",
            "identifier": self.identifier,
            "issued": self.issued,
            "signed": False,
            "bytes": len(self.content),
            "parameters": {
                "fitted": len(stated.fitted),
                "without_uncertainty": len(stated.unsure),
                "held": len(stated.held),
                "not_determined": len(stated.lost),
                "k": stated.k,
                "k_region": stated.k_region,
                "p": stated.p,
            },
            "tests": [
                {
                    "title": tests.title,
                    "conformity": tests.conformity,
                    "values": {value.name: value.conformity for value in tests.values},
                    "lifted": [each.figure for each in tests.lifted],
                    "without_cmc": list(tests.without),
                }
                for tests in self.tested
            ],
            "missing": self.missing,
        }


def dcc_certificate(
    result: str | Path,
    laboratory: str | Path,
    verification: Sequence[str | Path] = (),
    tested: Sequence[StatedTests] = (),
    issued: Issued | None = None,
) -> Certificate:
    """A DCC 3.3.0 of a result.json (or its folder) and a laboratory file. It is an unsigned draft,
    unless it was `issued`; signed it is in no case.

    verification: files that `ulna verify` wrote, of the same arm; tested: further tests. Raises UlnaInputError, also
    for a calibration that did not converge, tests of another arm, and texts that XML cannot hold.
    """
    path = result_file(Path(result))
    known = load_laboratory(laboratory) if issued is None else issued.on(load_laboratory(laboratory))
    calibration, stated = certified_result(path)
    found = calibration.result
    tested = [
        *(tests for each in verification for tests in stated_tests(Path(each), calibration, known.file)),
        *tested,
    ]
    languages = tuple(known.file.languages)
    root: Element = etree.Element(f"{{{DCC}}}digitalCalibrationCertificate", nsmap={**NAMES, "xsi": _XSI})
    root.set("schemaVersion", VERSION)
    root.set(f"{{{_XSI}}}schemaLocation", f"{DCC} {DCC}/v{VERSION}/dcc.xsd")
    of_laboratory, of_result = Sheet(languages, str(known.path)), Sheet(languages, str(path))
    data = administrative_data(of_laboratory, root, known)
    statements(of_result, of_result.dcc(data, "statements"), known, found, stated, issued)
    for tests in tested:
        conformity_statements(Sheet(languages, tests.source), data[-1], tests)
    measured = of_result.dcc(root, "measurementResults")
    _calibration(of_result, of_laboratory, measured, found, stated, known, calibration.file.sha256)
    for tests in tested:
        tests_result(Sheet(languages, tests.source), of_laboratory, measured, tests, known.file)
    etree.indent(root)
    content = bytes(etree.tostring(root, xml_declaration=True, encoding="UTF-8")) + b"\n"
    number = known.file.certificate.identifier
    return Certificate(content, number, stated, list(tested), _missing(known.file), issued is not None)


def _calibration(
    sheet: Sheet,
    of_laboratory: Sheet,
    measured: Element,
    found: Result,
    stated: StatedParameters,
    known: Laboratory,
    result_sha256: str,
) -> None:
    calibration = sheet.dcc(measured, "measurementResult")
    sheet.text(calibration, "name", sheet.own("dcc.calibration"))
    methods = sheet.dcc(calibration, "usedMethods")
    calibration_method(sheet, methods, found)
    laboratory_methods(of_laboratory, methods, known.file.method)
    software(sheet, sheet.dcc(calibration, "usedSoftware"), str(found.provenance["version"]))
    laboratory_conditions(of_laboratory, calibration, known.file)
    written = sheet.dcc(calibration, "results")
    results.parameters(sheet, written, found, stated, known.file.laboratory.accreditation is not None)
    results.fit(sheet, written, found)
    results.figures(sheet, written, found)
    files = [("result.json", result_sha256)] + [(file["path"], file["sha256"]) for file in found.provenance["files"]]
    input_files(sheet, sheet.dcc(calibration, "measurementMetaData"), files)


def _missing(file: LaboratoryFile) -> list[str]:
    """What a reader of a certificate would look for."""
    looked_for = {
        "traceability": file.traceability,
        "humidity": file.environment.humidity,
        "equipment": file.equipment or None,
        "issued": file.certificate.issued,
    }
    return [key for key, value in looked_for.items() if value is None]
