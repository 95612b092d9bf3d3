"""The same table as other programs write it, each by a writer that Ulna does not read with: the csv module, Polars,
openpyxl, SciPy, h5py. Each writer returns the keys that a study needs to read the file."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import openpyxl
import polars as pl
import scipy.io

Writer = Callable[[pl.DataFrame, Path], str]


def numbers_and_texts(table: pl.DataFrame, angles: str = "q") -> dict[str, Any]:
    """The angles as one array (N, n), the other columns as one each."""
    names = [name for name in table.columns if name.startswith(angles) and name[len(angles) :].isdecimal()]
    rest = {name: table[name].to_list() for name in table.columns if name not in names}
    return {angles: table.select(names).to_numpy(), **rest}


def dialect(separator: str, decimal: str, header: bool = True) -> Writer:
    def write(table: pl.DataFrame, path: Path) -> str:
        with path.open("w", newline="") as stream:
            writer = csv.writer(stream, delimiter=separator)
            if header:
                writer.writerow(table.columns)
            for row in table.rows():
                writer.writerow([repr(x).replace(".", decimal) if isinstance(x, float) else x for x in row])
        keys = f'separator = "{"tab" if separator == chr(9) else separator}"\ndecimal = "{decimal}"\n'
        names = ", ".join(f'{name} = "c{k}"' for k, name in enumerate(table.columns, start=1))
        return keys if header else f"{keys}header = false\ncolumns = {{ {names} }}\n"

    return write


def sheet(table: pl.DataFrame, path: Path, name: str = "Sheet1", edit: Callable[[Any], object] | None = None) -> str:
    """A workbook with one sheet; `edit` may spoil it."""
    book = openpyxl.Workbook()
    page = book.active
    page.title = name
    page.append(table.columns)
    for row in table.rows():
        page.append(list(row))
    if edit is not None:
        edit(page)
    book.save(path)
    return ""


def second_sheet(table: pl.DataFrame, path: Path) -> str:
    book = openpyxl.Workbook()
    book.active["A1"] = "about this file"
    page = book.create_sheet("run 1")
    for row in (table.columns, *table.rows()):
        page.append(list(row))
    book.save(path)
    return 'sheet = "run 1"\n'


def cells(values: list[Any]) -> np.ndarray:
    """A cell array, a column."""
    out = np.empty((len(values), 1), dtype=object)
    out[:, 0] = values
    return out


def _for_matlab(values: Any) -> Any:
    if isinstance(values, list):
        return cells(values) if isinstance(values[0], str) else np.array(values)[:, np.newaxis]
    return values


def mat(compressed: bool = False, struct: bool = False) -> Writer:
    def write(table: pl.DataFrame, path: Path) -> str:
        variables = {name: _for_matlab(values) for name, values in numbers_and_texts(table).items()}
        held = {"setup": {"run": variables}, "rate": 1000.0} if struct else variables
        scipy.io.savemat(path, held, do_compression=compressed)
        return 'dataset = "/setup/run"\n' if struct else ""

    return write


def struct_array(table: pl.DataFrame, path: Path) -> str:
    """As MATLAB's programmers collect: run(k).q = …, run(k).feature = …"""
    rows = numbers_and_texts(table)
    elements = np.empty(len(table), dtype=[(name, object) for name in rows])
    for k in range(len(table)):
        elements[k] = tuple(values[k] for values in rows.values())
    scipy.io.savemat(path, {"run": elements})
    return 'dataset = "run"\n'


def matlab73(table: pl.DataFrame, path: Path) -> str:
    """As MATLAB's `save -v7.3`: a block of 512 bytes before, arrays turned, cells by reference. (Without MATLAB here,
    after files that it wrote.)"""
    with h5py.File(path, "w", userblock_size=512) as file:
        inside = file.create_group("#refs#")

        def put(group: h5py.Group, name: str, values: np.ndarray, kind: str) -> h5py.Dataset:
            group[name] = values
            group[name].attrs["MATLAB_class"] = np.bytes_(kind)
            return group[name]

        for name, values in numbers_and_texts(table).items():
            if isinstance(values, list) and isinstance(values[0], str):
                codes = [np.frombuffer(text.encode("utf-16-le"), "<u2")[:, np.newaxis] for text in values]
                texts = [put(inside, f"{name}{k}", code, "char").ref for k, code in enumerate(codes)]
                put(file, name, np.array([texts], dtype=h5py.ref_dtype), "cell")
            else:
                put(file, name, np.atleast_2d(np.asarray(values, dtype=float).T), "double")
        put(file, "note", np.frombuffer("Monday".encode("utf-16-le"), "<u2")[:, np.newaxis], "char")
        file["none"] = np.array([0, 0], dtype="u8")
        file["none"].attrs["MATLAB_class"] = np.bytes_("double")
        file["none"].attrs["MATLAB_empty"] = np.uint8(1)
    content = path.read_bytes()
    start = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM"
    path.write_bytes(start + content[128:])
    return ""


def hdf5(table: pl.DataFrame, path: Path, **more: Any) -> str:
    with h5py.File(path, "w") as file:
        for name, values in (numbers_and_texts(table) | more).items():
            file[f"run1/{name}"] = values
        file["run2/notes"] = "nothing"
    return 'dataset = "/run1"\n'


def hdf5_columns(table: pl.DataFrame, path: Path) -> str:
    with h5py.File(path, "w") as file:
        for name in table.columns:
            file.create_dataset(name, data=table[name].to_list(), compression="gzip")
    return ""


def compound(table: pl.DataFrame, path: Path) -> str:
    rows = numbers_and_texts(table)
    width = rows["q"].shape[1]
    kinds = {name: "S20" if isinstance(values[0], str) else type(values[0]) for name, values in rows.items()}
    data = np.empty(len(table), dtype=[("q", "f8", (width,)), *((n, kinds[n]) for n in rows if n != "q")])
    for name, values in rows.items():
        data[name] = [v.encode() for v in values] if kinds[name] == "S20" else values
    with h5py.File(path, "w") as file:
        file["logs/monday"] = data
    return 'dataset = "logs/monday"\n'


def parquet(table: pl.DataFrame, path: Path) -> str:
    table.write_parquet(path)
    return ""


#: name of the file → its writer
WRITERS: dict[str, Writer] = {
    "commas.csv": dialect(",", "."),
    "semicolons.csv": dialect(";", ","),
    "tabs.txt": dialect("\t", "."),
    "bars.dat": dialect("|", ",", header=False),
    "table.parquet": parquet,
    "book.xlsx": sheet,
    "sheets.xlsx": second_sheet,
    "plain.mat": mat(),
    "compressed.mat": mat(compressed=True),
    "struct.mat": mat(struct=True),
    "structs.mat": struct_array,
    "new.mat": matlab73,
    "group.h5": hdf5,
    "columns.hdf5": hdf5_columns,
    "compound.h5": compound,
}
