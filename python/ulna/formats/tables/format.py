"""What a format of tables owes: how its files are recognised, opened, and called in messages.

No format unpacks what its file declares before that is compared with the file's size (`ulna.formats.unpacked`); a
library that crashes or hangs with damaged files is asked in a process of its own (`ulna.formats.asking`).

A new format is one file beside this one, which makes its own `ulna.formats.header.Header` of a file, and its row in
`registry.py`, a `TableFormat`; nobody else asks what kind of file a table is. `tests/contract/test_table_formats.py`
holds every row to what is written here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from ulna.formats.header import Header
from ulna.formats.layout import Layout


@dataclass(frozen=True, kw_only=True)
class TableFormat:
    """One format. What reads it is loaded when a file of it is opened."""

    name: str
    """Short: "Excel"."""
    listed: str
    """How a list of all formats calls it: ".xlsx"."""
    kind: str
    """How a message calls a file of it: "an Excel workbook"."""
    endings: tuple[str, ...]
    """How its files are usually called: ".xlsx". Nothing is decided by them: the content tells."""
    keys: tuple[str, ...]
    """What may be said of such a file: keys of `ulna.formats.layout.TableKeys`, besides `columns`."""
    recognised: Callable[[bytes], bool]
    """Whether a file that begins with these bytes (64 KiB, or all of it) is one."""
    open: Callable[[Path, bytes, str, Layout], Header]
    """(path, its first bytes, what is expected of it in words, how it is written) → its header. Raises UlnaInputError
    for a file that is damaged, or not written so."""

    def __post_init__(self) -> None:
        """Raises TypeError with all that a format falls short of."""
        missing = list(self._missing())
        if missing:
            raise TypeError(f"table format '{self.name}': {'; '.join(missing)}")

    def _missing(self) -> Iterable[str]:
        for word, what in (("name", "a short name"), ("listed", "its place in lists"), ("kind", 'as "a CSV file"')):
            if not getattr(self, word).strip():
                yield f"'{word}' is empty: say how messages call it ({what})"
        if not self.endings:
            yield "it has no endings: say how its files are usually called"
        for ending in self.endings:
            if not ending.startswith(".") or ending != ending.lower():
                yield f"ending '{ending}': begin it with a point, in small letters"
        for key in self.keys:
            if key not in Layout.KEYS:
                yield f"key '{key}': no key of TableKeys; known are {', '.join(Layout.KEYS)}"
