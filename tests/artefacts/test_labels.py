"""Labels of rows have the manners of an array of objects, which is what they are compared with."""

from __future__ import annotations

import pickle

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ulna.artefacts.labels import Labels

ROWS = st.lists(st.sampled_from(["", "1", "left", "links", "左"]), max_size=12)


@given(ROWS, st.sampled_from(["", "left", "nowhere"]), st.randoms(use_true_random=False))
def test_labels_do_what_an_array_of_objects_does(rows: list[str], asked: str, random: np.random.RandomState) -> None:
    there = np.array(rows, dtype=object)
    labels = Labels.of(there)
    assert len(labels) == len(rows)
    assert labels.tolist() == list(labels) == rows == np.asarray(labels).tolist()
    assert (labels == asked).tolist() == [row == asked for row in rows]
    assert (labels != asked).tolist() == [row != asked for row in rows]
    mask = np.array([random.random() < 0.5 for _ in rows], dtype=bool)
    assert labels[mask].tolist() == there[mask].tolist()
    assert labels[1:].tolist() == rows[1:]
    assert [labels[k] for k in range(len(rows))] == rows
    assert pickle.loads(pickle.dumps(labels)).tolist() == rows
    assert (labels == there).all()


@given(st.lists(ROWS, min_size=1, max_size=4), st.randoms(use_true_random=False))
def test_numbers_count_as_labels_appear(parts: list[list[str]], random: np.random.RandomState) -> None:
    rows = [row for part in parts for row in part]
    joined = Labels.joined([Labels.of(part) for part in parts])
    assert joined.tolist() == rows
    assert len(set(joined.names)) == len(joined.names)
    mask = np.array([random.random() < 0.5 for _ in rows], dtype=bool)
    kept = [row for row, there in zip(rows, mask, strict=True) if there]
    numbers, names = joined[mask].as_they_appear()  # labels of rows left out are not counted
    assert names == list(dict.fromkeys(kept))
    assert [names[number] for number in numbers.tolist()] == kept
