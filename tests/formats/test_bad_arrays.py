"""What is said to MAT and HDF5 files: arrays of other shapes, kinds and lengths, other places, damage."""

from __future__ import annotations

import re
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import polars as pl
import pytest
import scipy.io
import scipy.sparse
from tests.foreign_tables import WRITERS, cells, matlab73
from tests.small_study import BARS, STUDY, SmallStudy, says

from ulna import UlnaInputError

TABLE = pl.read_csv(BARS.encode())
Q = TABLE.select("q1", "q2", "q3").to_numpy()
PLACEMENT = TABLE["placement"].to_numpy()
FEATURE = TABLE["feature"].to_list()


def told(folder: Path, file: str, keys: str = "") -> str:
    small = SmallStudy(folder)
    small.write("study.toml", STUDY.replace('file = "bars.csv"\n', f'file = "{file}"\n{keys}\n'))
    return small.error()


def write_mat(path: Path, variables: dict[str, Any]) -> None:
    scipy.io.savemat(path, {n: cells(v) if isinstance(v, list) else v for n, v in variables.items()}, oned_as="column")


def write_hdf5(path: Path, variables: dict[str, Any]) -> None:
    with h5py.File(path, "w") as file:
        for name, values in variables.items():
            file[name] = values


KINDS: dict[str, Callable[[Path, dict[str, Any]], None]] = {"m.mat": write_mat, "h.h5": write_hdf5}
NAN = np.where(np.arange(24).reshape(8, 3) == 7, np.nan, Q)

#: what is other than in a good file, and what the message says
CASES: dict[str, tuple[dict[str, Any], tuple[str, ...]]] = {
    "turned": (
        {"q": Q.T},
        ("'q4' is one too many", "8 columns q…", "'q' is 3 × 8: expected numbers, one row for each reading"),
    ),
    "three dimensions": ({"q": np.zeros((8, 3, 2))}, ("'q1' is missing", "'q' is an array of 8 × 3 × 2: expected")),
    "complex": ({"q": Q + 1j}, ("'q1' is missing", "'q' is an array of complex numbers: expected numbers")),
    "too short": (
        {"placement": PLACEMENT[:5]},
        ("placement has 5 rows", "q1, q2, q3", "have 8", "one value of each for every reading"),
    ),
    "not a number": ({"q": NAN}, ("row 3, column 'q2': got 'nan', expected a finite number",)),
    "twice": ({"q1": Q[:, 0]}, ("the column 'q1' appears twice",)),
    "texts for numbers": ({"temperature": ["20"] * 8}, ("column 'temperature': holds texts; expected numbers",)),
    "an empty name": ({"feature": ["A", "", *FEATURE[2:]]}, ("row 2, column 'feature': the cell is empty", "a name")),
    "no angles": ({"q": np.zeros(8)}, ("'q1' is missing", "none such (", "'q' is 8 × 1: expected numbers")),
    "no rows": ({"q": np.zeros((0, 3)), "placement": np.zeros(0), "feature": np.zeros(0)}, ("there are no rows",)),
}


@pytest.mark.parametrize("file", KINDS)
@pytest.mark.parametrize("case", CASES)
def test_what_arrays_are_told(tmp_path: Path, case: str, file: str) -> None:
    changed, fragments = CASES[case]
    KINDS[file](tmp_path / file, {"q": Q, "placement": PLACEMENT, "feature": FEATURE, **changed})
    says(told(tmp_path, file), str(tmp_path / file), *fragments)


def test_what_mat_files_hold_besides(tmp_path: Path) -> None:
    def with_feature(feature: Any) -> str:
        scipy.io.savemat(tmp_path / "m.mat", {"q": Q, "placement": PLACEMENT, "feature": feature})
        return told(tmp_path, "m.mat")

    says(with_feature(cells([np.zeros((2, 2))] * 8)), "'feature': a cell holds something else than a text or a number")
    says(with_feature({"A": 1}), "there is no column 'feature'")
    says(with_feature(scipy.sparse.eye(8)), "column 'feature': is a sparse matrix; expected a column")
    scipy.io.savemat(tmp_path / "m.mat", {"a": {"q": Q}, "b": {"q": Q}})
    says(told(tmp_path, "m.mat"), "no arrays at the top of the file, only a, b", 'Say dataset = "a" in [[readings]]')
    says(told(tmp_path, "m.mat", 'dataset = "c"'), "'readings.1.dataset': got 'c'", "Known: a, b")
    says(told(tmp_path, "m.mat", 'dataset = "/a/p"'), "'readings.1.dataset': got '/a/p'", "Did you mean 'a/q'?")
    says(told(tmp_path, "m.mat", 'dataset = "/a/q/r"'), "got '/a/q/r'", "Known: a, b")
    scipy.io.savemat(tmp_path / "m.mat", {"a": {"b": {"q": Q}}})
    says(told(tmp_path, "m.mat", 'dataset = "a"'), "no arrays at 'a', only a/b", 'dataset = "a/b"')


def test_what_hdf5_files_hold_besides(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "h.h5", "w") as file:
        file["q"], file["placement"] = Q, PLACEMENT
        file["feature"] = np.array([file["q"].ref] * 8, dtype=h5py.ref_dtype)
        file["group/one"] = 1
        file["latin"] = np.array([b"\xc4"] * 8)
    says(told(tmp_path, "h.h5"), "column 'feature': is an array of references or arrays; expected a column")
    says(told(tmp_path, "h.h5", 'columns = { id = "latin" }'), "column 'feature': is an array of references")
    says(told(tmp_path, "h.h5", 'dataset = "/gruop"'), "'readings.1.dataset': got '/gruop'", "Did you mean 'group'?")
    with h5py.File(tmp_path / "h.h5", "a") as file:
        del file["feature"]
        file.move("latin", "feature")
    says(told(tmp_path, "h.h5"), "'feature': texts that are not UTF-8", "Write it as UTF-8")
    with h5py.File(tmp_path / "g.h5", "w") as file:
        file["monday/q"], file["tuesday/q"] = Q, Q
    says(told(tmp_path, "g.h5"), "only /monday, /tuesday", 'Say dataset = "/monday" in [[readings]]')
    with h5py.File(tmp_path / "e.h5", "w"):
        pass
    says(told(tmp_path, "e.h5"), "there are no arrays at the top of the file; expected columns")


def test_pictures_and_claims_are_no_columns(tmp_path: Path) -> None:
    """An array much wider than a table, or larger than its file can hold, does not become a million columns."""
    with h5py.File(tmp_path / "h.h5", "w") as file:
        file["q"], file["placement"], file["feature"] = Q, PLACEMENT, FEATURE
        file["film"] = np.zeros((2, 20_000), dtype="u1")
        file.create_dataset("vast", shape=(1 << 40, 3), dtype="f8", chunks=(1024, 3))
    small = SmallStudy(tmp_path)
    small.write("study.toml", STUDY.replace("bars.csv", "h.h5"))
    _, warned = small.load()
    assert warned == [f"{tmp_path / 'h.h5'}: not used: the columns film, vast."]
    with h5py.File(tmp_path / "h.h5", "a") as file:
        del file["q"]
        file.move("vast", "q")
    says(small.error(), "'q1' is missing", "more than the file can hold")


@pytest.mark.parametrize("file", ["plain.mat", "compressed.mat", "structs.mat"])
def test_any_byte_of_a_mat_file_may_be_wrong(tmp_path: Path, file: str) -> None:
    """A message or readings, never anything else. (HDF5 is read by a library that promises less.)"""
    small = SmallStudy(tmp_path)
    keys = WRITERS[file](TABLE, tmp_path / file)
    small.write("study.toml", STUDY.replace('file = "bars.csv"\n', f'file = "{file}"\n{keys}'))
    content = (tmp_path / file).read_bytes()
    rng = np.random.default_rng(4)
    refused = 0
    spoilt = [content[:k] for k in range(129, len(content), 61)]
    for k in range(128, len(content)):
        spoilt.append(content[:k] + bytes([int(rng.integers(256))]) + content[k + 1 :])
    for each in spoilt[:: max(1, len(spoilt) // 400)]:
        small.write(file, each)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                small.load()
            except UlnaInputError as error:
                says(str(error), str(tmp_path))
                refused += 1
    assert refused > 20


@pytest.mark.parametrize("file", ["new.mat", "group.h5"])
def test_half_a_file(tmp_path: Path, file: str) -> None:
    keys = WRITERS[file](TABLE, tmp_path / file)
    content = (tmp_path / file).read_bytes()
    for part in (600, len(content) // 2, len(content) - 100):
        (tmp_path / file).write_bytes(content[:part])
        message = told(tmp_path, file, keys)
        says(message, f"{tmp_path / file}: ", "cannot be read", "The file is damaged: write it again")


def test_matlabs_own_kinds_in_the_new_format(tmp_path: Path) -> None:
    matlab73(TABLE, tmp_path / "n.mat")
    with h5py.File(tmp_path / "n.mat", "a") as file:
        file["T"] = np.zeros((1, 6), dtype="u4")
        file["T"].attrs["MATLAB_class"] = np.bytes_("table")
    small = SmallStudy(tmp_path)
    small.write("study.toml", STUDY.replace("bars.csv", "n.mat"))
    _, warned = small.load()
    assert [re.sub(".*: not", "not", warning) for warning in warned] == ["not used: the columns T, note."]
    says(told(tmp_path, "n.mat", 'columns = { id = "T" }'), "column 'T' (id): is a MATLAB table; expected a column")


def test_a_file_that_is_still_being_written(tmp_path: Path) -> None:
    code = (
        "import sys, h5py\nf = h5py.File(sys.argv[1], 'w')\nf['q'] = 1\nf.flush()\nprint('ready', flush=True)\ninput()"
    )
    writer = subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path / "h.h5")], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    try:
        assert writer.stdout is not None
        assert writer.stdout.readline() == "ready\n"
        says(told(tmp_path, "h.h5"), "h.h5: another program has this file open to write", "Close it there")
    finally:
        writer.communicate("\n", timeout=30)
