"""What an arm can be in: one row each, known by its ending, with the options that go with it."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import pytest

from ulna.exchange.drawings import FORMS, Asked, read_drawing
from ulna.ground.errors import UlnaInputError

OPTIONS = [each.name for each in fields(Asked)]


def test_each_ending_is_one_form_and_each_option_goes_with_one() -> None:
    endings = [ending for form in FORMS for ending in form.endings]
    assert len(set(endings)) == len(endings)
    assert all(ending == ending.lower() and ending.startswith(".") for ending in endings)
    assert {option for form in FORMS for option in form.options} == set(OPTIONS)


@pytest.mark.parametrize("form", FORMS, ids=lambda form: form.what)
def test_an_option_that_does_not_go_with_it_is_refused(form, tmp_path: Path) -> None:
    path = tmp_path / f"arm{form.endings[0]}"
    path.write_text("")
    for option in sorted(set(OPTIONS) - set(form.options)):
        given = (1.0, 2.0, 3.0) if option == "tip" else "mm"
        with pytest.raises(UlnaInputError, match=f"option --{option.replace('_', '-')}: got it for .*{path.name}"):
            read_drawing(path, Asked(**{option: given}))


def test_an_ending_is_known_in_capitals_too(tmp_path: Path) -> None:
    path = tmp_path / "ARM.TOML"
    path.write_text("")
    with pytest.raises(UlnaInputError, match="ulna-arm/1"):
        read_drawing(path, Asked())
