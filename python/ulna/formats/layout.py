"""How a table is written where it is not as Ulna expects: separators, sheet, data set, columns by other names.

Nothing of this is guessed in silence. What a file needs and nobody said is an error that names the key, or, where the
file leaves no doubt, seen and remarked upon; a key that a file has no use for is an error too.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar, Literal, TypeVar

from pydantic import Field

from ulna.formats.encodings import known as known_encoding
from ulna.formats.header import Header
from ulna.formats.models import Strict
from ulna.formats.near_names import near_names
from ulna.formats.spelling import Spelling
from ulna.ground.errors import UlnaInputError, nearest

AnyHeader = TypeVar("AnyHeader", bound=Header)


class TableKeys(Strict):
    """How a table is written; the same keys for readings and for features."""

    separator: str | None = None
    """CSV: the character between columns, or "tab"; a comma where it is not given."""
    decimal: Literal[".", ","] | None = None
    """CSV: the decimal sign; a point where it is not given."""
    thousands: Literal[",", ".", "'", " "] | None = None
    """CSV: the sign between the thousands of numbers; none where it is not given."""
    encoding: str | None = None
    """CSV: in which letters it is written, such as "cp1252" or "gbk"; UTF-8 where it is not given."""
    comment: Annotated[str, Field(min_length=1)] | None = None
    """CSV and Excel: rows that begin with this sign are not read."""
    header: bool | Annotated[int, Field(ge=1)] = True
    """CSV and Excel: the line or row of the file that names the columns, where that is not found; false where no row
    does and the first is data; the columns are then called c1, c2, …"""
    units_row: bool | None = None
    """CSV and Excel: whether the row below the header holds units and no reading; seen where it is not said."""
    fill_down: Annotated[list[str], Field(min_length=1)] | None = None
    """CSV and Excel: columns in which an empty cell, or a ditto mark, means what the cell above says."""
    sheet: str | None = None
    """Excel: which sheet, where there are several."""
    dataset: str | None = None
    """HDF5: the group or data set that holds the columns; MAT: the struct variable."""
    columns: Annotated[dict[str, str], Field(min_length=1)] | None = None
    """Ulna's name = the file's name, where they differ."""
    names: Annotated[dict[str, dict[str, str | list[str]]], Field(min_length=1)] | None = None
    """Of a column with labels: Ulna's name = what stands in the file's cells, or a list of that."""


@dataclass(frozen=True)
class Layout:
    """The same, checked, and how messages call its keys."""

    KEYS: ClassVar[tuple[str, ...]] = tuple(key for key in TableKeys.model_fields if key not in ("columns", "names"))

    separator: str | None = None
    """One character."""
    decimal: str | None = None
    thousands: str | None = None
    encoding: str | None = None
    comment: str | None = None
    header: bool | int = True
    units_row: bool | None = None
    fill_down: Sequence[str] = ()
    sheet: str | None = None
    dataset: str | None = None
    columns: Mapping[str, str] = field(default_factory=dict)
    names: Mapping[str, Mapping[str, str | Sequence[str]]] = field(default_factory=dict)
    place: tuple[str, str] = ("key '", "'")
    """Before and after a key's name where a message calls it: `study.toml: key 'readings.1.sheet'`, or `--sheet`."""
    table: str = "[[readings]]"
    """Where a key is to be written; "" for options of a command."""

    @classmethod
    def of(cls, keys: TableKeys, place: tuple[str, str], table: str) -> Layout:
        """Of a table in a study. Raises UlnaInputError for keys that cannot be meant."""
        given = {name: getattr(keys, name) for name in TableKeys.model_fields}
        empty = {"columns": keys.columns or {}, "names": keys.names or {}, "fill_down": tuple(keys.fill_down or ())}
        return cls(**given | empty, place=place, table=table).checked()

    @classmethod
    def of_options(
        cls,
        columns: Sequence[str] | Mapping[str, str] | None = None,
        names: Sequence[str] | Mapping[str, Mapping[str, str | Sequence[str]]] | None = None,
        **given: Any,
    ) -> Layout:
        """Of options of a command; columns: `q1=shoulder` each, or a mapping; names: `probe.tip=Taster 1` each, or a
        mapping as in a study. Raises UlnaInputError as `of`."""
        pairs: dict[str, str] = dict(columns) if isinstance(columns, Mapping) else {}
        for pair in () if columns is None or isinstance(columns, Mapping) else columns:
            ours, equals, theirs = pair.partition("=")
            if not (ours and equals and theirs) or ours in pairs:
                raise UlnaInputError(
                    f"--column: got '{pair}'; expected Ulna's name = the file's name, each once, such as "
                    "q1=shoulder_pan_joint. Correct it."
                )
            pairs[ours] = theirs
        decimal = given.get("decimal")
        if decimal not in (None, ".", ","):
            raise UlnaInputError(f"--decimal: got '{decimal}'; expected '.' or ','. Correct it.")
        labels: dict[str, Mapping[str, str | Sequence[str]]] = {}
        if isinstance(names, Mapping):
            labels = dict(names)
        else:
            found: dict[str, dict[str, list[str]]] = {}
            for name in names or ():
                match = re.fullmatch(r"([^.=]+)\.([^=]+)=(.+)", name)
                if match is None:
                    raise UlnaInputError(
                        f"--name: got '{name}'; expected column.Ulna's name = what stands in the file's cells, such as "
                        "'probe.tip=Taster 1'. Correct it."
                    )
                found.setdefault(match[1], {}).setdefault(match[2], []).append(match[3])
            labels.update(found)
        return cls(**given, columns=pairs, names=labels, place=("--", ""), table="").checked()

    def checked(self) -> Layout:
        """The same, `tab` as the character that it is. Raises UlnaInputError for keys that cannot be meant."""
        found = dataclasses.replace(self, separator="\t" if self.separator == "tab" else self.separator)
        found._check_separator()
        found._check_thousands()
        if found.encoding is not None and not known_encoding(found.encoding):
            raise UlnaInputError(
                f"{found.key('encoding')}: got '{found.encoding}', which nobody knows; expected such as utf-8, cp1252, "
                "gbk or utf-16. Correct it."
            )
        if found.header is False and not found.columns:
            raise UlnaInputError(
                f"{found.key('header')}: says that the file does not name its columns; expected to be told which they "
                f"are. Say {found.say('columns', {'q1': 'c1'})}: c1 is the first column of the file."
            )
        return found

    def _check_separator(self) -> None:
        separator, decimal = self.separator, self.decimal
        if separator is not None and (
            len(separator) != 1
            or not (separator == "\t" or " " <= separator <= "~")
            or separator.isalnum()
            or separator in "\"'.+-_"
        ):
            raise UlnaInputError(
                f"{self.key('separator')}: got {separator!r}; expected one character that is no letter, digit, quote, "
                "sign or point, such as ';' or '|', or 'tab'. Correct it."
            )
        if decimal == "," and separator in (None, ","):
            got = "but there is no key 'separator'" if separator is None else "and the separator is a comma as well"
            raise UlnaInputError(
                f"{self.key('decimal')}: numbers have a decimal comma, {got}; expected another sign between columns. "
                f"Say which, such as {self.say('separator', ';')}."
            )

    def _check_thousands(self) -> None:
        if self.thousands is not None and self.thousands not in (",", ".", "'", " "):
            raise UlnaInputError(
                f"{self.key('thousands')}: got '{self.thousands}'; expected ',', '.', an apostrophe or a blank. "
                "Correct it."
            )
        if self.thousands is not None and self.thousands == (self.decimal or "."):
            raise UlnaInputError(
                f"{self.key('thousands')}: got '{self.thousands}', which is the decimal sign as well; expected "
                f"another. Correct it, or say {self.say('decimal', ',' if self.thousands == '.' else '.')}."
            )

    @property
    def spelling(self) -> Spelling:
        """How the numbers of the table are written."""
        return Spelling(self.decimal or ".", self.thousands or "")

    def key(self, name: str) -> str:
        """How a message calls a key that was given."""
        if not self.table:
            name = "no-header" if name == "header" and self.header is False else name
            name = {"columns": "column", "names": "name"}.get(name, name).replace("_", "-")
        return name.join(self.place)

    def say(self, name: str, value: str | bool | int | Mapping[str, str] | list[str]) -> str:
        """What to write to say something of the table: a key with its value, and where; or an option."""
        flag = name.replace("_", "-")
        if isinstance(value, Mapping):
            pairs = [f'{ours} = "{theirs}"' for ours, theirs in value.items()]
            text = f"{name} = {{ {', '.join(pairs)}, … }}"
            option = " ".join(f"--column {ours}={theirs}" for ours, theirs in value.items())
        elif isinstance(value, bool):
            text, option = f"{name} = {str(value).lower()}", f"--{'' if value else 'no-'}{flag}"
        elif isinstance(value, int):
            text, option = f"{name} = {value}", f"--{flag} {value}"
        elif isinstance(value, list):
            text = f"{name} = [" + ", ".join(f'"{each}"' for each in value) + "]"
            option = " ".join(f"--{flag} {each}" for each in value)
        else:
            text, option = f'{name} = "{value}"', f'--{flag} "{value}"'
        return f"{text} in {self.table}" if self.table else option

    @property
    def given(self) -> list[str]:
        """The keys that say something of a file, but `columns`, in their order."""
        return [key for key in self.KEYS if getattr(self, key) != getattr(AS_EXPECTED, key)]

    def mapped(self, header: AnyHeader, known: Sequence[str]) -> AnyHeader:
        """The table with its columns called as `columns` says. `known`: Ulna's names. Raises UlnaInputError."""
        theirs: dict[str, str] = {}
        for ours, name in self.columns.items():
            if ours not in known:
                raise UlnaInputError(
                    f"{self.key('columns')}: '{ours}' is no column that Ulna knows; expected Ulna's name = the file's "
                    f"name.{nearest(ours, known)} Correct it."
                )
            if name not in header.columns:
                raise UlnaInputError(
                    f"{self.key('columns')}: {ours} is to be the column '{name}', but {header.path} has none of this "
                    f"name.{nearest(name, header.columns)} Correct it."
                )
            if name in theirs:
                raise UlnaInputError(
                    f"{self.key('columns')}: {theirs[name]} and {ours} are both to be the column '{name}' of "
                    f"{header.path}; expected one name for each column. Correct one of them."
                )
            theirs[name] = ours
        for name, ours in theirs.items():
            if ours in header.columns and ours not in theirs:
                raise UlnaInputError(
                    f"{self.key('columns')}: {ours} is to be the column '{name}', but {header.path} has a column "
                    f"'{ours}' as well; expected one of them. Remove {ours} from the key, or rename a column."
                )
        near, units = near_names(header, known, theirs)
        if near:
            shown = ", ".join(f"'{name}' as {ours}" for name, ours in near.items())
            told = f"{header.path}: columns taken by their names: {shown}."
            header = dataclasses.replace(header, remarks=[*header.remarks, told])
        if units:
            header = dataclasses.replace(header, units={**header.units, **units})
        return self._labelled(header.renamed({name: ours for name, ours in (theirs | near).items() if name != ours}))

    def _labelled(self, header: AnyHeader) -> AnyHeader:
        """The table with the cells of its columns called as `names` says. Raises UlnaInputError."""
        labels: dict[str, dict[str, str]] = {}
        for column, names in self.names.items():
            if column not in header.columns:
                raise UlnaInputError(
                    f"{self.key('names')}: there is no column '{column}' in {header.path}."
                    f"{nearest(column, header.columns)} Correct it."
                )
            own = labels.setdefault(column, {})
            for ours, cells in names.items():
                for cell in [cells] if isinstance(cells, str) else cells:
                    if own.setdefault(cell.strip(), ours) != ours:
                        raise UlnaInputError(
                            f"{self.key('names')}: '{cell}' in the column '{column}' is to be {own[cell.strip()]} and "
                            f"{ours}; expected one name for each label. Correct one of them."
                        )
        return dataclasses.replace(header, labels=labels) if labels else header


AS_EXPECTED = Layout()
