"""Laboratory files: everything that can be wrong with one, the template, the example and the fossil."""

from __future__ import annotations

import datetime
import re
from pathlib import Path

import pytest

from ulna.documents.laboratory.capability import least_expanded
from ulna.documents.laboratory.file import load_laboratory
from ulna.documents.laboratory.iso_codes import COUNTRIES, LANGUAGES, SLIPS
from ulna.documents.laboratory.tables import LaboratoryFile
from ulna.documents.laboratory.template import TEMPLATE
from ulna.documents.laboratory.texts import unwritable
from ulna.ground.errors import UlnaInputError
from ulna.verification.decision import Limit

HERE = Path(__file__).resolve().parents[1]
EXAMPLE = HERE.parent / "examples" / "platinum" / "laboratory.toml"
FOSSIL = HERE / "data" / "fossils" / "lab-1.toml"

#: keys that came after the fossil
LATER = {"cmc", "scanner", "condition", "artefacts"}

CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "format": ('"ulna-lab/1"', '"ulna-study/1"', ("another kind of file", "ulna-lab/1")),
    "country": ('country = "DE"\nbegin', 'country = "UK"\nbegin', ("'certificate.country'", "'UK'", "'GB'")),
    "country of an address": ('country = "GB"', 'country = "Gb"', ("'customer.address.country'", "'Gb'", "'GB'")),
    "a list as a country": (
        'country = "DE"\nbegin',
        'country = ["DE"]\nbegin',
        ("'certificate.country'", "ISO 3166-1"),
    ),
    "a list as a language": ('["en", "de"]', '["en", ["de"]]', ("'languages.2'", "ISO 639-1")),
    "language": ('["en", "de"]', '["en", "DE"]', ("'languages.2'", "'DE'", "ISO 639-1", "did you mean 'de'")),
    "language twice": ('["en", "de"]', '["en", "en", "de"]', ("'languages'", "stands twice")),
    "a language too few": ('["en", "de"]', '["en", "de", "fr"]', ("'laboratory.name'", "en, de, expected", "fr")),
    "a language too many": ('de = "Kugelstab"', 'de = "K", fr = "B"', ("'equipment.1.name'", "en, de, fr")),
    "an unknown language": ('de = "Kugelstab"', 'qq = "K"', ("'equipment.1.name'", "'qq'", "ISO 639-1")),
    "no identifier": ('identifier = "EX-2026-0042"\n', "", ("'certificate.identifier' is missing",)),
    "empty": ('"EX-2026-0042"', '" "', ("'certificate.identifier'", "not empty", "fill it in")),
    "a number": ('"EX-2026-0042"', "42", ("'certificate.identifier'", "got 42", "a text in quotes")),
    "blanks": ('"P07-0815"', '"P07-0815 "', ("'item.serial'", "without blanks at its ends")),
    "two lines": ('"P07-0815"', '"P07\\n0815"', ("'item.serial'", "one line")),
    "control character": ('"P07-0815"', '"P07\\u0007"', ("'item.serial'", "U+0007", "certificate cannot hold")),
    "in a text": ('"Kugelstab"', '"Kugel\\u001bstab"', ("'equipment.1.name'", "'de'", "U+001B")),
    "date in quotes": ("begin = 2026-03-30", 'begin = "2026-03-30"', ("'certificate.begin'", "a date without quotes")),
    "date and time": ("begin = 2026-03-30", "begin = 2026-03-30T08:00:00", ("'certificate.begin'", "a date without")),
    "end before begin": ("end = 2026-03-31", "end = 2026-03-29", ("'certificate.end'", "2026-03-29, before 'begin'")),
    "issued too early": ("issued = 2026-04-01", "issued = 2026-03-30", ("'certificate.issued'", "before 'end'")),
    "location": (
        'location = "laboratory"',
        'location = "lab"',
        ("'certificate.location'", "'lab'", "'customerBranch'"),
    ),
    "no signer": ("main_signer = true", "main_signer = false", ("'person'", "0 persons", "exactly one")),
    "two signers": ('de = "Bearbeiter" }', 'de = "B" }\nmain_signer = true', ("'person'", "2 persons", "exactly one")),
    "one bracket": ("[[method]]", "[method]", ("'method'", "two brackets")),
    "web": (
        '"https://laboratory.example/lengths"',
        '"laboratory.example"',
        ("'laboratory.web'", "an address such as https://"),
    ),
    "script": (
        '"https://laboratory.example/lengths"',
        '"javascript:alert(1)"',
        ("'laboratory.web'", "an address such as https://"),
    ),
    "no unit": (', unit = "°C"', "", ("'environment.temperature.unit' is missing",)),
    "unit": ('unit = "°C"', 'unit = "°F"', ("'environment.temperature.unit'", "'°F'", "'°C' or 'K'")),
    "value without u": ("u = 0.2, ", "", ("'environment.temperature'", "has value", "value and u")),
    "low over high": ("low = 42", "low = 52", ("'environment.humidity'", "low is 52 and high 48")),
    "humidity over 100": ("high = 48", "high = 480", ("'environment.humidity.high'", "at most 100")),
    "issuer": ('issuer = "customer"', 'issuer = "me"', ("'item.identifications.1.issuer'", "'me'")),
    "unknown key": ("[traceability]", "[tracability]", ("unknown key 'tracability'", "Did you mean 'traceability'?")),
    "logo": ('web = "https', 'logo = "none.svg"\nweb = "https', ("'laboratory.logo'", "none.svg is not there")),
}


@pytest.mark.parametrize("case", CASES)
def test_what_is_wrong_is_told(case: str, tmp_path: Path) -> None:
    old, new, expected = CASES[case]
    text = EXAMPLE.read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "lab.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(UlnaInputError) as caught:
        load_laboratory(path)
    message = str(caught.value)
    for part in (str(path), *expected):
        assert part in message


def test_the_example() -> None:
    laboratory = load_laboratory(EXAMPLE)
    assert laboratory.main_signer.name == "Erika Muster"
    assert laboratory.file.certificate.begin == datetime.date(2026, 3, 30)
    assert laboratory.spoken(laboratory.file.item.name, "de") == "Gelenkarm-Koordinatenmessgerät"
    assert laboratory.spoken("the same", "fr") == "the same"
    assert laboratory.logo is None
    with pytest.raises(UlnaInputError, match=r"'languages': the texts are in en, de, but .* 'zh' was asked"):
        laboratory.spoken(laboratory.file.item.name, "zh")


def test_the_fossil_has_every_key_and_loads() -> None:
    laboratory = load_laboratory(FOSSIL)
    file = laboratory.file
    tables = [
        file,
        file.certificate,
        file.laboratory,
        file.customer,
        file.item,
        file.environment,
        file.equipment[0],
        file.method[0],
    ]
    for table in tables:
        assert table.model_fields_set == set(type(table).model_fields) - LATER
    assert isinstance(file, LaboratoryFile)
    assert laboratory.logo == FOSSIL.parent / "lab-1.svg"
    assert laboratory.main_signer.name == "李四"
    assert file.environment.humidity is not None
    assert (file.environment.humidity.value, file.environment.humidity.u) == (45.5, 2.5)
    assert (file.environment.temperature.low, file.environment.temperature.unit) == (292.15, "K")
    assert file.certificate.replaces is not None
    assert file.certificate.replaces.change == "substituted"


def test_the_fossil_with_a_capability_loads() -> None:
    file = load_laboratory(FOSSIL.parent / "lab-1-cmc.toml").file
    assert file.item.scanner == "laser line scanner"
    assert file.cmc is not None
    assert least_expanded(file.cmc) == {"P_Size": Limit(0.0254), "E_Uni": Limit(0.0508, 500000.0)}


def test_the_fossil_with_a_condition_loads() -> None:
    file = load_laboratory(FOSSIL.parent / "lab-1-condition.toml").file
    assert (file.item.condition, file.person[0].role) == ("scratched", {"en": "R"})
    assert file.equipment[0].artefacts == ["bar", "gauge-1"]


def test_a_capability_of_no_figure_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "lab.toml"
    text = (FOSSIL.parent / "lab-1-cmc.toml").read_text(encoding="utf-8")
    path.write_text(text.replace("P_Size = 0.001", "P_Siz = 0.001"), encoding="utf-8")
    with pytest.raises(UlnaInputError, match=r"key 'cmc\.figure\.P_Siz': no test gives a figure .*'P_Size'"):
        load_laboratory(path)
    path.write_text(text.replace("P_Size = 0.001", "P_Size = -0.001"), encoding="utf-8")
    with pytest.raises(UlnaInputError, match=r"'cmc\.figure\.P_Size'"):
        load_laboratory(path)
    path.write_text(text.replace('unit = "in"\n', ""), encoding="utf-8")
    with pytest.raises(UlnaInputError, match=r"'cmc\.unit'"):
        load_laboratory(path)


def test_the_template_is_refused_until_it_is_filled_in(tmp_path: Path) -> None:
    path = tmp_path / "lab.toml"
    path.write_text(TEMPLATE, encoding="utf-8")
    with pytest.raises(UlnaInputError, match=r"'certificate.identifier'.*fill it in"):
        load_laboratory(path)


def test_the_template_filled_in_loads_and_has_every_key(tmp_path: Path) -> None:
    """Every comment that hides a key is taken away, every empty text filled."""
    text = "\n".join(
        re.sub(r"^# (?=[a-z_]+ = |\[)", "", line) if not line.startswith("# value") else line
        for line in TEMPLATE.splitlines()
    )
    text = re.sub(r'(begin|end) = ""', r"\1 = 2026-03-30", text)
    text = re.sub(r'(country) = ""', r'\1 = "DE"', text).replace('"https://"', '"https://a.example"')
    text = re.sub(r'value = "", u = ""', "value = 20, u = 1", text).replace('""', '"x"')
    path = tmp_path / "lab.toml"
    path.write_text(text, encoding="utf-8")
    (tmp_path / "logo.svg").write_text("<svg/>")
    file = load_laboratory(path).file
    assert file.model_fields_set == set(LaboratoryFile.model_fields)
    assert file.laboratory.model_fields_set == set(type(file.laboratory).model_fields)
    assert file.item.model_fields_set == set(type(file.item).model_fields)
    assert file.certificate.model_fields_set == set(type(file.certificate).model_fields)


@pytest.mark.parametrize(
    ("link", "good"),
    [
        ("https://a.example", True),
        ("http://a.example:8080/ü/x%20y?q=1&r=/?#part", True),
        ("https://a%zz", False),
        ("https://a.example/%4", False),
        ("https://a.example/x y", False),
        ("http://[::1", False),
        ("https://a#b#c", False),
        ("https://a:b:c", False),
        ("ftp://a.example", False),
        ("https://", False),
    ],
)
def test_links(link: str, good: bool, tmp_path: Path) -> None:
    text = EXAMPLE.read_text(encoding="utf-8").replace("https://laboratory.example/lengths", link)
    (tmp_path / "lab.toml").write_text(text, encoding="utf-8")
    if good:
        assert load_laboratory(tmp_path / "lab.toml").file.laboratory.web == link
    else:
        with pytest.raises(UlnaInputError, match=r"'laboratory\.web'.*expected an address such as https://"):
            load_laboratory(tmp_path / "lab.toml")


def test_codes() -> None:
    assert {len(code) for code in COUNTRIES} == {len(code) for code in LANGUAGES} == {2}
    assert len(COUNTRIES) == 249
    assert {"DE", "CN", "GB", "AF", "ZW"} <= COUNTRIES
    assert {"de", "zh", "en"} <= LANGUAGES
    assert not set(SLIPS) & COUNTRIES
    assert set(SLIPS.values()) <= COUNTRIES


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("a\tb\nc", None),
        ("مرحبا ‮", None),
        ("\x00", "U+0000"),
        ("a\x7fb", None),
        ("\ufffe", "U+FFFE"),
        ("\ud800", "U+D800"),
    ],
)
def test_what_xml_cannot_hold(text: str, code: str | None) -> None:
    assert unwritable(text) == code


def test_all_that_is_wrong_is_told_at_once(tmp_path: Path) -> None:
    """Every case alone gives one problem; several in one file give them all, of the same kind at the least."""
    text = EXAMPLE.read_text(encoding="utf-8")
    for old, new in (
        ('"EX-2026-0042"', "42"),
        ('"P07-0815"', '"P07-0815 "'),
        ('country = "DE"\nbegin', 'country = "UK"\nbegin'),
    ):
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "lab.toml").write_text(text.replace("[certificate]", "[certificate]\nnumbre = 3"), encoding="utf-8")
    with pytest.raises(UlnaInputError) as told:
        load_laboratory(tmp_path / "lab.toml")
    message = str(told.value)
    assert message.startswith(f"{tmp_path / 'lab.toml'}: 4 problems:\n- unknown key 'certificate.numbre'")
    for key in ("'certificate.identifier'", "'item.serial'", "'certificate.country'"):
        assert f"\n- key {key}" in message


def test_all_that_keys_say_together_is_told_at_once(tmp_path: Path) -> None:
    text = EXAMPLE.read_text(encoding="utf-8")
    text = text.replace('["en", "de"]', '["en", "de", "fr"]')
    text = text.replace("begin = 2026-03-30", "begin = 2036-03-30").replace("main_signer = true", "main_signer = false")
    (tmp_path / "lab.toml").write_text(text, encoding="utf-8")
    with pytest.raises(UlnaInputError) as told:
        load_laboratory(tmp_path / "lab.toml")
    message = str(told.value)
    assert "problems:" in message
    for part in ("'laboratory.name'", "'equipment.1.name'", "'certificate.end'", "0 persons have main_signer"):
        assert part in message
