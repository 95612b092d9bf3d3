"""A report says of signs that are not told two things at most, however many sets of joints there are."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from tests.cli_runs import write_lengths
from tests.reports import calibrated

from ulna.documents.gather import gather
from ulna.documents.languages.text import plain
from ulna.documents.languages.words import Words
from ulna.documents.sections.summary import counts

MIRRORED = [[1, 3], [1, 3, 5], [1, 3, 7], [1, 3, 5, 7], [1, 3, 6]]
SAME = [[2]]
EXPECTED = {
    "en": "1, 3 or 1, 3, 5 or 1, 3, 7 or one of 2 more sets",
    "de": "1, 3 oder 1, 3, 5 oder 1, 3, 7 oder einer von 2 weiteren Sätzen",
    "zh": "1, 3 或 1, 3, 5 或 1, 3, 7 或其余 2 组之一",
}


def test_many_sets_are_one_point_of_the_list(tmp_path: Path) -> None:
    content = gather(calibrated(write_lengths(tmp_path)))
    fit = dataclasses.replace(content.fit, undecided_signs=[*SAME, *MIRRORED], mirrored_signs=MIRRORED)
    for language, expected in EXPECTED.items():
        words = Words(language)
        (before,), (after,) = counts(content, words), counts(dataclasses.replace(content, fit=fit), words)
        new = [plain(said) for said in after.items if said not in before.items]
        assert len(new) == len(after.items) - len(before.items) == 2
        assert expected in new[0]
        assert new[1] == plain(words("summary.signs", joints=("2",)))
