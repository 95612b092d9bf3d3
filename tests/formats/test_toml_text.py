"""What Ulna writes as TOML is read back by another hand, Python's own tomllib, as it was."""

from __future__ import annotations

import math
import struct
import tomllib
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ulna.formats.toml_text import toml_key, toml_value

TEXTS = st.text(st.characters(exclude_categories=("Cs",)), max_size=12)
PLAIN = st.one_of(TEXTS, st.booleans(), st.integers(-(2**63), 2**63 - 1), st.floats(allow_nan=False))
VALUES = st.recursive(
    PLAIN, lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(TEXTS, inner, max_size=3)), max_leaves=8
)


@given(st.dictionaries(TEXTS, VALUES, max_size=5))
def test_what_is_written_comes_back(table: dict[str, Any]) -> None:
    text = "".join(f"{toml_key(key)} = {toml_value(value)}\n" for key, value in table.items())
    assert tomllib.loads(text) == table


@given(st.floats())
def test_numbers_come_back_to_the_last_bit(number: float) -> None:
    for given_number in (number, np.float64(number)):
        back = tomllib.loads(f"x = {toml_value(given_number)}")["x"]
        assert type(back) is float, "a number with a fraction or none stays one"
        if math.isnan(number):
            assert math.isnan(back)
        else:
            assert struct.pack("d", back) == struct.pack("d", number)


def test_numbers_of_other_makes() -> None:
    assert toml_value([np.int64(3), np.float64(0.1), (True, 2)]) == "[3, 0.1, [true, 2]]"
    assert toml_value({"a": 1.0, "ß b": "c"}) == '{ a = 1.0, "ß b" = "c" }'


@pytest.mark.parametrize("value", [None, 1j, np.zeros(2), b"text", {1, 2}])
def test_what_is_no_value_is_told(value: Any) -> None:
    with pytest.raises(TypeError, match="no value of a TOML file; expected a text, a number"):
        toml_value(value)
