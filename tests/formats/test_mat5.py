"""The reader of MAT files beside SciPy's: what SciPy writes, and files put together by hand after the format."""

from __future__ import annotations

import re
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import scipy.sparse
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from ulna.formats.tables.mat5 import DamagedError, Strange, Struct, entries, value

DTYPES = st.sampled_from(["f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "?"])
ARRAYS = DTYPES.flatmap(
    lambda dtype: hnp.arrays(dtype, hnp.array_shapes(min_dims=2, max_dims=4, min_side=0, max_side=5))
)


def read(path: Path, name: str) -> Any:
    (entry,) = [entry for entry in entries(path) if entry.name == name]
    return value(path, entry)


@given(ARRAYS, st.booleans())
def test_arrays_of_numbers(tmp_path_factory: pytest.TempPathFactory, array: np.ndarray, compressed: bool) -> None:
    path = tmp_path_factory.mktemp("mat", numbered=True) / "a.mat"
    scipy.io.savemat(path, {"before": "x", "a": array, "after": 1.0}, do_compression=compressed)
    assert [(entry.name, entry.kind) for entry in entries(path)] == [
        ("before", "char"),
        ("a", "numbers"),
        ("after", "numbers"),
    ]
    assert entries(path)[1].shape == array.shape
    np.testing.assert_array_equal(read(path, "a"), scipy.io.loadmat(path)["a"])
    np.testing.assert_array_equal(read(path, "a"), array)


def plain(held: Any) -> Any:
    """What was read as nested Python objects, as SciPy's below."""
    if isinstance(held, Struct):
        return {name: [plain(each) for each in values] for name, values in held.fields.items()}
    if held.dtype == object:
        return [each if isinstance(each, str) else plain(each) for each in held.reshape(-1, order="F")]
    return held.tolist()


def plain_scipy(held: Any) -> Any:
    if held.dtype.names:
        return {name: [plain_scipy(each) for each in held[name].reshape(-1, order="F")] for name in held.dtype.names}
    if held.dtype == object:
        return [plain_scipy(each) for each in held.reshape(-1, order="F")]
    return held.tolist()


@pytest.mark.parametrize("compressed", [False, True])
def test_texts_cells_and_structs(tmp_path: Path, compressed: bool) -> None:
    cell = np.empty((2, 3), dtype=object)
    for k, each in enumerate(["a", "", "Größe µ", np.eye(2), np.zeros((0, 3)), "x" * 300]):
        cell[k % 2, k // 2] = each
    run = np.empty((3, 1), dtype=[("q", object), ("a_rather_long_name_of_a_field", object)])
    for k in range(3):
        run[k, 0] = (np.arange(7.0) + k, f"run {k}")
    variables = {
        "text": "a text with Ω",
        "rows": np.array(["one", "three", "µ"]),
        "cell": cell,
        "run": run,
        "nested": {"a": {"b": {"c": 1.0}}, "d": "e"},
        "none": np.array([]),
    }
    scipy.io.savemat(tmp_path / "a.mat", variables, do_compression=compressed)
    theirs = scipy.io.loadmat(tmp_path / "a.mat", chars_as_strings=True)
    assert [entry.name for entry in entries(tmp_path / "a.mat")] == list(variables)
    for name in variables:
        found = read(tmp_path / "a.mat", name)
        assert plain(found) == plain_scipy(theirs[name]), name
    assert read(tmp_path / "a.mat", "rows").tolist() == ["one  ", "three", "µ    "]


def test_what_is_no_array_is_named(tmp_path: Path) -> None:
    scipy.io.savemat(tmp_path / "a.mat", {"c": np.ones((2, 2)) * 1j, "s": scipy.sparse.eye(3), "q": np.eye(2)})
    kinds = {entry.name: entry.kind for entry in entries(tmp_path / "a.mat")}
    assert kinds == {"c": "an array of complex numbers", "s": "a sparse matrix", "q": "numbers"}
    assert read(tmp_path / "a.mat", "c") == Strange("an array of complex numbers")
    assert read(tmp_path / "a.mat", "s") == Strange("a sparse matrix")


def element(order: str, kind: int, content: bytes) -> bytes:
    return struct.pack(f"{order}II", kind, len(content)) + content + bytes(-len(content) % 8)


def matrix(order: str, number: int, shape: tuple[int, ...], name: str, *parts: bytes) -> bytes:
    flags = element(order, 6, struct.pack(f"{order}II", number, 0))
    dimensions = element(order, 5, struct.pack(f"{order}{len(shape)}i", *shape)) if shape else b""
    return element(order, 14, flags + dimensions + element(order, 1, name.encode()) + b"".join(parts))


def file_of(order: str, *elements: bytes) -> bytes:
    return b"MATLAB 5.0 MAT-file".ljust(124) + (b"\x00\x01IM" if order == "<" else b"\x01\x00MI") + b"".join(elements)


@pytest.mark.parametrize("order", ["<", ">"])
def test_both_orders_of_bytes(tmp_path: Path, order: str) -> None:
    numbers = np.arange(6.0).reshape(2, 3)
    q = matrix(order, 6, (2, 3), "q", element(order, 9, numbers.astype(f"{order}f8").tobytes("F")))
    kind_and_length = struct.pack("<HH", 1, 2) if order == "<" else struct.pack(">HH", 2, 1)
    short = matrix(order, 9, (1, 2), "n", kind_and_length + b"\x07\x08\0\0")
    text = matrix(order, 4, (1, 2), "t", element(order, 17, "µΩ".encode("utf-16-le" if order == "<" else "utf-16-be")))
    (tmp_path / "a.mat").write_bytes(file_of(order, q, short, text))
    assert read(tmp_path / "a.mat", "q").tolist() == numbers.tolist()
    assert read(tmp_path / "a.mat", "n").tolist() == [[7, 8]]
    assert read(tmp_path / "a.mat", "t").tolist() == ["µΩ"]
    theirs = scipy.io.loadmat(tmp_path / "a.mat")
    assert (theirs["q"] == numbers).all()
    assert theirs["n"].tolist() == [[7, 8]]


def test_tables_and_strings_of_matlab_are_named(tmp_path: Path) -> None:
    opaque = matrix("<", 17, (), "T", element("<", 1, b"MCOS"), element("<", 1, b"table"))
    hidden = matrix("<", 9, (1, 1), "", element("<", 2, b"\x01"))  # MATLAB's own, after it
    (tmp_path / "a.mat").write_bytes(file_of("<", opaque, hidden))
    assert [(entry.name, entry.kind) for entry in entries(tmp_path / "a.mat")] == [("T", "a MATLAB table")]


WRONG = {
    "too few numbers": (matrix("<", 6, (2, 3), "q", element("<", 9, bytes(40))), "5 numbers for a shape of"),
    "half a number": (matrix("<", 6, (1, 1), "q", element("<", 9, bytes(7))), "ends within a number"),
    "a number of no type": (matrix("<", 6, (1, 1), "q", element("<", 99, bytes(8))), "an unknown type 99"),
    "a longer part": (matrix("<", 6, (1, 1), "q", struct.pack("<II", 9, 1 << 31)), "larger than what is left"),
    "a class of no kind": (matrix("<", 77, (1, 1), "q", element("<", 9, bytes(8))), "an unknown class 77"),
    "fewer cells": (matrix("<", 1, (1 << 20, 1 << 10), "q"), "fewer cells than its shape says"),
    "no cell": (matrix("<", 1, (1, 1), "q", element("<", 9, bytes(8))), "holds no variable"),
    "negative": (matrix("<", 6, (-1, 3), "q", element("<", 9, b"")), "a variable of shape"),
    "fewer letters": (matrix("<", 4, (2, 3), "q", element("<", 16, b"abc")), "3 characters for a shape of"),
    "no UTF-8": (matrix("<", 4, (1, 1), "q", element("<", 16, b"\xff")), "a text is not utf-8"),
    "no fields": (matrix("<", 2, (1, 1), "q", element("<", 5, struct.pack("<i", 0)), element("<", 1, b"")), "fields"),
    "nothing known": (element("<", 9, bytes(8)), "there is no variable at byte 128"),
    "no end": (struct.pack("<II", 14, 1000), "ends within the variable"),
    "no zlib": (element("<", 15, b"nothing!"), "cannot be decompressed"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_not_built_as_the_format_says(tmp_path: Path, case: str) -> None:
    content, expected = WRONG[case]
    (tmp_path / "a.mat").write_bytes(file_of("<", content))
    with pytest.raises(DamagedError, match=expected):
        read(tmp_path / "a.mat", "q")


WRITTEN_BY_OTHERS = sorted((Path(scipy.io.__file__).parent / "matlab" / "tests" / "data").glob("*.mat"))


@pytest.mark.skipif(not WRITTEN_BY_OTHERS, reason="this SciPy comes without its tests' files")
def test_files_that_matlab_and_octave_wrote() -> None:
    """Of several versions, compressed and not, of both orders of bytes: they come with SciPy."""
    compared = 0
    for path in WRITTEN_BY_OTHERS:
        if path.read_bytes()[124:128] not in (b"\x00\x01IM", b"\x01\x00MI") or re.match(
            "bad|broken|malf|corr|nasty|test_empty_struct", path.name
        ):
            continue  # of version 4 or 7.3, or meant to be damaged
        theirs = scipy.io.loadmat(path)
        for entry in entries(path):
            found = value(path, entry)
            assert (entry.name in theirs) or entry.kind == "a MATLAB function", path.name
            nothing = entry.name in theirs and "None" in repr(theirs[entry.name])  # a struct without fields
            if entry.kind in ("numbers", "char", "cell", "struct") and "Strange" not in repr(found) and not nothing:
                assert plain(found) == plain_scipy(theirs[entry.name]), f"{path.name}: {entry.name}"
                compared += 1
    assert compared > 50
