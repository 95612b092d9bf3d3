"""Numbers, labels, units and words of certificates, each by a law of its own."""

from __future__ import annotations

import math
import re
from decimal import Decimal
from urllib.parse import unquote

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.dcc_reading import exponents

from ulna.documents.certified.parameters import last_place
from ulna.documents.dcc.administrative import release
from ulna.documents.dcc.quantities import label, number, plain
from ulna.documents.dcc.units import dsi_product, dsi_unit

UNITS = ("mm", "rad", "1/K", "rad/(N m)")


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_read_back_the_same(value: float) -> None:
    text = number(value)
    assert float(text) == value
    assert re.fullmatch(r"-?(\d+\.\d*|\d+)([eE][-+]?\d+)?", text)
    assert not text.startswith("-0.0") or value != 0.0


@given(st.floats(min_value=1.0, max_value=1e300))
def test_coverage_factors_have_no_exponent(value: float) -> None:
    assert float(plain(value)) == value
    assert re.fullmatch(r"[1-9]\d*\.\d*", plain(value))


@given(st.text())
def test_a_label_is_one_entry_of_a_list_and_reads_back(name: str) -> None:
    assert not re.search(r"[ \t\n\r]", label(name))
    assert unquote(label(name), errors="surrogatepass") == name


@given(st.floats(min_value=1e-15, max_value=1e15))
def test_the_last_place_leaves_two_digits_of_u(expanded: float) -> None:
    place = last_place(expanded)
    assert place is not None
    digits = int((Decimal(expanded) / Decimal(10) ** place).to_integral_value())
    assert 10 <= digits <= 99


@pytest.mark.parametrize(("expanded", "place"), [(0.0123, -3), (0.0996, -2), (9.96, 0), (250.0, 1), (1.0, -1)])
def test_last_places_by_hand(expanded: float, place: int) -> None:
    assert last_place(expanded) == place


def test_nothing_is_rounded_where_u_is_zero() -> None:
    assert last_place(0.0) is None
    assert last_place(math.nan) is None


@pytest.mark.parametrize("first", UNITS)
@pytest.mark.parametrize("second", UNITS)
def test_products_of_units(first: str, second: str) -> None:
    assert dsi_product(first, second) == dsi_product(second, first)
    one, other = exponents(dsi_unit(first)), exponents(dsi_unit(second))
    both = {name: one.get(name, 0) + other.get(name, 0) for name in one | other}
    assert exponents(dsi_product(first, second)) == {name: power for name, power in both.items() if power}


def test_units_by_hand() -> None:
    assert dsi_unit("mm") == r"\milli\metre"
    assert dsi_unit("1") == r"\one"
    assert dsi_unit("1/K") == r"\kelvin\tothe{-1}"
    assert dsi_product("mm", "mm") == r"\milli\metre\tothe{2}"
    assert dsi_product("rad", "mm") == r"\milli\metre\radian"


@pytest.mark.parametrize(
    ("version", "text"), [("0.1.0", "v0.1.0"), ("1.2.3.dev4+g12", "v1.2.3"), ("2", "v2"), ("unknown", "v0")]
)
def test_releases(version: str, text: str) -> None:
    assert release(version) == text
    assert re.fullmatch(r"[a-zA-Z]( )?([0-9]{1,3}\.){0,3}([0-9]{1,3})", text)
