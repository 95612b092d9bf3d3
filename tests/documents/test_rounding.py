"""Values and their U as a certificate prints them (GUM 7.2.6), by hand and by law."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ulna.ground.digits import rounded


@pytest.mark.parametrize(
    ("value", "expanded", "unit", "shown"),
    [
        (12.34567, 0.0996, "mm", ("12.35", "0.10")),  # to two digits first, then the place
        (123.456, 9.96, "mm", ("123", "10")),
        (123.456, 9.94, "mm", ("123.5", "9.9")),
        (-1.23456, 0.0123, "mm", ("-1.235", "0.012")),
        (-0.0004, 0.012, "mm", ("0.000", "0.012")),  # no minus before a zero
        (1234.5678, 123.4, "mm", ("1230", "120")),
        (-56789.0, 1234.0, "mm", ("-56800", "1200")),
        (1.5707963, 0.0000031, "rad", ("1.5707963", "0.0000031")),
        (443.172, 0.00000025, "mm", ("443.17200000", "0.00000025")),
        (0.5, 0.0, "mm", ("0.5", "0")),
        (443.172, None, "mm", ("443.1720", "–")),
        (2.5, 10.0, "mm", ("2", "10")),  # halves to even
        (3.5, 10.0, "mm", ("4", "10")),
        (0.0, 0.012, "mm", ("0.000", "0.012")),
        (1.1456e-5, 2.34e-7, "1/K", ("1.146e-5", "2.3e-7")),
        (-1.1456e-5, 9.96e-7, "1/K", ("-1.15e-5", "1.0e-6")),
        (1e-9, 2.3e-7, "1/K", ("0", "2.3e-7")),
    ],
)
def test_rounding_by_hand(value, expanded, unit, shown):
    assert rounded(value, expanded, unit) == shown


@given(st.floats(-1e4, 1e4), st.floats(1e-9, 1e3))
def test_rounding_loses_no_more_than_half_of_the_last_place(value, expanded):
    shown, u = rounded(value, expanded, "mm")
    digits = u.replace(".", "").lstrip("0")
    assert len(digits) == 2 or (float(u) >= 100.0 and set(digits[2:]) == {"0"})
    assert len(shown.partition(".")[2]) == len(u.partition(".")[2])
    assert abs(float(u) - expanded) <= 0.0501 * expanded
    place = 10.0 ** -len(u.partition(".")[2]) if "." in u else 10.0 ** (len(u) - 2)
    assert abs(float(shown) - value) <= 0.5 * place * (1 + 1e-9) + 1e-12
    assert not (shown.startswith("-") and float(shown) == 0.0)
