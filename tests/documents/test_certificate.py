"""What a certificate must say (ISO/IEC 17025:2017, 7.8.2, 7.8.4 and 7.8.6), where, and in which notation."""

from __future__ import annotations

import ast
import dataclasses
import json
import re
from pathlib import Path
from typing import Any

import pytest
from tests.acceptance import write_plan
from tests.certificates import EXAMPLE, MINIMAL
from tests.cli_runs import run, write_lengths
from tests.pdf_reading import Pdf, holds, squeezed
from tests.reports import calibrated

import ulna
from ulna.documents.content.content import Content
from ulna.documents.content.model import Model
from ulna.documents.gather import gather
from ulna.documents.languages.text import plain
from ulna.documents.languages.words import Words, dictionary
from ulna.documents.pdf import order
from ulna.documents.pdf.render import render, texts_in
from ulna.documents.pdf.text import decimals
from ulna.documents.sections.departures import COUNTED, departure
from ulna.documents.sections.method import method
from ulna.documents.sections.verbatim import AXES, LEFT_OUT, PROFILES, english
from ulna.verification.bench import counted, counted_each, within_shares
from ulna.verification.kinds.registry import KINDS
from ulna.verification.profile import load_profile

LANGUAGES = ("en", "de", "zh")


@pytest.fixture(scope="module")
def lengths(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return calibrated(write_lengths(tmp_path_factory.mktemp("certificate")))


@pytest.fixture(scope="module")
def as_left(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A verification.json of points, as left."""
    folder = tmp_path_factory.mktemp("tested")
    write_plan(folder)
    done = run("verify", folder / "plan.toml", "-o", folder / "tested")
    assert done.returncode in (0, 1), done.stderr
    return folder / "tested" / "verification.json"


@pytest.fixture(scope="module")
def as_found(as_left: Path) -> Path:
    """The same as found, where it fails."""
    document = json.loads(as_left.read_text(encoding="utf-8"))
    for state in document["states"]:
        state["state"], state["verdict"] = "as-found", "fail"
    path = as_left.parent / "as-found.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


def printed(content: Content, language: str) -> list[str]:
    """Texts of a certificate without annex, before they are set."""
    return list(texts_in(order.parts(content, Words(language), annex=False)))


def laboratory(folder: Path, *changes: tuple[str, str], text: str = MINIMAL) -> Path:
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "lab.toml"
    path.write_text(text, encoding="utf-8")
    return path


# statements


@pytest.mark.parametrize("language", LANGUAGES)
def test_statements_of_every_certificate(lengths: Path, tmp_path: Path, language: str) -> None:
    words = dictionary(language)
    said = printed(gather(lengths, laboratory=laboratory(tmp_path)), language)
    assert words["statement.item-alone"] in said
    assert words["statement.in-full"] in said
    assert words["statement.annex"] not in said
    xml = ulna.certificate(lengths, laboratory(tmp_path, ('["en"]', f'["{language}"]')), form="dcc").decode()
    for key in ("statement.item-alone", "statement.in-full"):
        assert f">{words[key]}<" in xml
    assert words["statement.in-full"] not in printed(gather(lengths), language), "a report is no certificate"


@pytest.mark.parametrize("language", ["en", "de"])
def test_they_are_on_paper(lengths: Path, tmp_path: Path, language: str) -> None:
    words = dictionary(language)
    pdf = Pdf(ulna.certificate(lengths, laboratory(tmp_path), language=language))
    holds(pdf, words["statement.item-alone"], words["statement.in-full"], words["paper.end"])


def test_the_condition_on_receipt_is_said_or_that_nobody_said_it(lengths: Path, tmp_path: Path) -> None:
    holds(Pdf(ulna.certificate(lengths, laboratory(tmp_path))), "Condition on receipt not stated")
    looked = laboratory(tmp_path, ('serial = "1"', 'serial = "1"\ncondition = "scratched & greasy"'))
    holds(Pdf(ulna.certificate(lengths, looked)), "Condition on receipt scratched & greasy")
    assert "scratched &amp; greasy" in ulna.certificate(lengths, looked, form="dcc").decode()
    first = Pdf(ulna.certificate(lengths, EXAMPLE)).texts[0]
    for day in ("Received2026-03-27", "Calibration begun2026-03-30", "Calibration ended2026-03-31"):
        assert squeezed(day) in squeezed(first)


# conformity, as found and as left


def test_the_verdict_is_on_the_first_page_with_its_rule_and_no_solver_is(lengths: Path, as_left: Path) -> None:
    pdf = Pdf(ulna.certificate(lengths, EXAMPLE, [as_left]))
    content = gather(lengths, verified=as_left)
    assert content.verification is not None
    verdict = dictionary("en")[f"conformity.{content.verification.file.states[0].verdict or 'none'}"]
    first = squeezed(pdf.texts[0])
    for said in (
        f"On the whole: {verdict} (as left)",
        "Decision rule, in the manner of ISO 14253-1",
        "No acceptance test",
    ):
        assert squeezed(said) in first, said
    solver = ("sum of squares", "converged", "Chi-squared", "degrees of freedom:", "Q–Q")
    assert not [each for each in solver if squeezed(each) in pdf.all_text]
    long = Pdf(ulna.certificate(lengths, EXAMPLE, [as_left], annex=True))
    text = long.all_text
    annex = text.index(squeezed("Annex: diagnostics of the calibration"))
    assert text.index(squeezed("The fit converged")) > annex
    assert text.index(squeezed("Date, signature")) < annex
    holds(long, "Chi-squared per degree of freedom" if content.fit.chi2_per_dof else "No noise was stated", "Q–Q")


def test_as_found_and_as_left_come_from_two_files(lengths: Path, as_found: Path, as_left: Path) -> None:
    pdf = Pdf(ulna.certificate(lengths, EXAMPLE, [as_left, as_found]))
    first = squeezed(pdf.texts[0])
    assert first.index(squeezed("FAIL (as found)")) < first.index(squeezed("(as left)"))
    assert squeezed("No acceptance test of the arm as found") not in first
    figures = json.loads(as_left.read_text(encoding="utf-8"))["states"][0]["tests"][0]["figures"]
    for state in ("as found", "as left"):
        holds(pdf, f"{state} {figures[0]['name']}")
    holds(pdf, *(each.sha256 for each in gather(lengths, verified=[as_left, as_found]).provenance.beside))


def test_a_state_twice_or_another_rule_is_refused(lengths: Path, as_found: Path, as_left: Path, tmp_path: Path) -> None:
    with pytest.raises(ulna.UlnaInputError, match=r"key 'states': as-left, as-left.*each state once"):
        gather(lengths, verified=[as_left, as_left])
    document = json.loads(as_found.read_text(encoding="utf-8"))
    document["decision"]["k"] = 3.0
    (tmp_path / "other.json").write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(ulna.UlnaInputError, match=r"other\.json: key 'decision'.*one decision rule"):
        gather(lengths, verified=[as_left, tmp_path / "other.json"])


# how


def said_of(content: Content, language: str = "en") -> str:
    (paragraph,) = method(content, Words(language))
    return plain(paragraph.text)  # type: ignore[union-attr]


def test_the_method_of_the_parameters_is_said(lengths: Path) -> None:
    content = gather(lengths)
    text = said_of(content)
    assert f"chain of {content.joints} joints, links after Denavit and Hartenberg; nothing beyond geometry" in text
    assert f"to {content.fit.readings} encoder readings" in text
    assert f"Software: ulna {ulna.__version__}." in text
    alike, weighted = "all readings weighed the same", "weighted by its stated noise"
    for chi2, yes, no in ((None, alike, weighted), (1.0, weighted, alike)):
        other = said_of(dataclasses.replace(content, fit=dataclasses.replace(content.fit, chi2_per_dof=chi2)))
        assert yes in other
        assert no not in other
    model = Model([2, 3], ["compliance", "encoder-harmonics"])
    fit = dataclasses.replace(content.fit, loss="huber")
    text = said_of(dataclasses.replace(content, model=model, fit=fit))
    assert "those of joints 2, 3 after Hayati; beyond geometry: joint compliance, encoder harmonics" in text
    assert "counted less (loss: huber)" in text
    for language, part in (("de", "Methode der kleinsten Quadrate"), ("zh", "最小二乘法")):
        assert part in said_of(content, language)
    holds(Pdf(render(content, "de", annex=False)), "Methode der kleinsten Quadrate")


def test_artefacts_stand_with_their_u_and_their_certificates(lengths: Path, as_left: Path, tmp_path: Path) -> None:
    """Names are those of the plan's verify file and of the study; a name that no standard has is not stated."""
    artefacts = json.loads(as_left.read_text(encoding="utf-8"))["artefacts"]
    ball = next(each for each in artefacts if each["kind"] == "ball")
    standard = f'[[equipment]]\nname = "Ball"\nserial = "B"\ncertificate = "C-77"\nartefacts = ["{ball["name"]}"]\n'
    lab = laboratory(tmp_path, text=MINIMAL + standard)
    pdf = Pdf(ulna.certificate(lengths, lab, [as_left]))
    u = f"{ball['u']:.2g}" if ball["u"] >= 1e-4 else None
    row = rf"{squeezed(ball['name'])}ball{squeezed('acceptance test')}{squeezed('diameter')}{ball['diameter']:g}mm"
    assert u is not None
    assert re.search(rf"{row}{re.escape(u)}0*mmC77", pdf.all_text)
    assert re.search(rf"{squeezed('acceptance test')}length[\d.;]+mm[\d.]+mm{squeezed('not stated')}", pdf.all_text)
    assert squeezed("Artefacts of the calibration and of the acceptance test") in pdf.all_text


# notation and language


def test_the_certificate_of_the_example_has_three_pages_at_most(root: Path) -> None:
    result = root / "tests" / "data" / "fossils" / "result-1.json"
    for language in ("en", "de"):
        assert len(Pdf(ulna.certificate(result, EXAMPLE, language=language)).texts) <= 3


def test_decimals_stand_behind_a_comma_in_german_and_behind_a_point_elsewhere() -> None:
    for text, german in (
        ("0.0031", "0,0031"),
        ("-1.5727795", "-1,5727795"),
        ("5.0e-6 rad", "5,0e-6 rad"),
        ("291.5; 582.25 mm", "291,5; 582,25 mm"),
        ("Version 0.1.0", "Version 0.1.0"),
        ("ISO/IEC 17025:2017, 7.8.2.1", "ISO/IEC 17025:2017, 7.8.2.1"),
        ("Ende. 2 Werte", "Ende. 2 Werte"),
    ):
        assert decimals(text, "de") == german
        assert decimals(text, "en") == decimals(text, "zh") == text


def test_a_german_certificate_is_german(lengths: Path, as_left: Path) -> None:
    """With its annex, but for why something is not determined, which the core says in English, marked so."""
    content = gather(lengths, laboratory=EXAMPLE, verified=as_left)
    assert content.identification.lost
    all_known = dataclasses.replace(content.identification, lost=[], weak=[])
    for annex, known in ((False, content.identification), (True, all_known)):
        shown = dataclasses.replace(content, identification=known)
        text = "\n".join(Pdf(render(shown, "de", annex=annex)).texts)
        text = re.sub("[\u2066-\u2069\u00ad\u200b]", "", text)
        assert len(re.findall(r"\d,\d", text)) > 50
        text = re.sub(r"^[\dA-Z]+\.\d+ ", "", text, flags=re.M)  # numbers of headings
        text = text.replace(str(lengths.parents[1]), "")  # paths of the files
        names = r"16857\.12|ulna 0\.\d+\.\d+|[\w.:]+:Tact\.AArm|[\w-]+\.(?:json|toml|csv)"
        assert re.findall(r"(?<![\w.])\d+\.\d+(?![\w.])", re.sub(names, "", text)) == []
        english_words = re.compile(r"\b(the|of|and|is|not|with|from|measured|counts|on)\b")
        assert [each for each in text.splitlines() if english_words.search(each)] == []


def test_what_a_verification_says_in_english_is_known_in_every_language(tmp_path: Path) -> None:
    """The catalogue holds the sentences of the definitions and of the profiles, word by word."""
    english = dictionary("en")
    definitions = {
        each.key: each for kind in KINDS.values() for table in kind.examples() for each in kind.figures(table)
    }
    assert len(definitions) > 10
    for key, each in definitions.items():
        own = english["formula-of.faro-spat"].format(axis=AXES[key]) if key in AXES else english[f"formula-of.{key}"]
        assert own == each.formula
    for name in PROFILES:
        assert english[f"manner.{name}"] == load_profile(name, tmp_path, "").file.statement
    for said, key in LEFT_OUT.items():
        assert english[f"left-out.{key}"] == said


def test_a_statement_of_ones_own_stays_as_it_is(lengths: Path, as_left: Path, tmp_path: Path) -> None:
    document: dict[str, Any] = json.loads(as_left.read_text(encoding="utf-8"))
    document["profile"]["statement"] = "Evaluated as agreed with the customer."
    (tmp_path / "own.json").write_text(json.dumps(document), encoding="utf-8")
    pdf = Pdf(ulna.certificate(lengths, EXAMPLE, [tmp_path / "own.json"], language="de"))
    holds(pdf, "Evaluated as agreed with the customer.")


def test_departures_are_known_in_every_language(root: Path) -> None:
    """All that are counted, by the sources, and what is compared with a share."""
    kinds = root / "python" / "ulna" / "verification" / "kinds"
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in kinds.glob("*.py")]
    calls = [node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Call)]
    named = [each for each in calls if getattr(each.func, "id", "") in ("counted", "counted_each")]
    what = {each.args[0].value for each in named if isinstance(each.args[0], ast.Constant)}
    assert len(what) == len(COUNTED) == len(named)
    made = [said for each in what for said in counted(str(each), 1, 5)]
    made += [said for each in what for said in counted_each(str(each), {"a: b": 2}, 5)]
    made += within_shares("seat", {"s1": 100.0}, [(0.5, 0.7)], 2000.0)
    for said in [*made, "test 'bi' (E_Bi) was not measured."]:
        assert plain(departure(said, Words("en"))) == said
        for language in ("de", "zh"):
            text = plain(departure(said, Words(language)))
            assert not re.search(r"\b(the|profile|of|was|measured|counts)\b", text), text
            assert re.findall(r"\d+", text) == re.findall(r"\d+", said)
    assert departure("something new", Words("de")) == english("something new")
