"""Source files, `ulna-source/1`: read, and a url alone as one of its own."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path

from ulna.formats.models import check_kind, fill
from ulna.formats.toml import check_format, read_toml
from ulna.ground.errors import UlnaInputError
from ulna.live.decode.binary import Packets
from ulna.live.decode.decoder import Decoder
from ulna.live.decode.fields import Fields
from ulna.live.decode.json_values import JsonValues
from ulna.live.journal import MAGIC, Reading
from ulna.live.samples import MOST_CHANNELS
from ulna.live.tables import DECODERS, BinaryTable, DecodeTable, FieldsTable, JsonTable, SourceFile
from ulna.live.url import Url

WHAT = 'a source file (TOML, format = "ulna-source/1")'


@dataclass(frozen=True)
class StatedSource:
    """A source as somebody stated it."""

    file: SourceFile
    url: Url
    path: Path
    """The file; of a url alone "source"."""
    folder: Path
    """What paths in the url are relative to."""

    def decoder(self, otherwise: DecodeTable, midway: bool, messages: bool) -> Decoder:
        """As the file says, else as the kind of source has it. Raises UlnaInputError."""
        table = self.file.decode or otherwise
        if isinstance(table, BinaryTable) and table.sync is None and not messages:
            raise UlnaInputError(
                f"{self.path}: key 'decode.sync' is missing; expected the bytes before each packet, as "
                f"{self.url.scheme}: "
                "gives a stream without beginnings. Add it."
            )
        return _made(table, midway)


def read_source(given: str | Path) -> StatedSource:
    """A source by its url, by a file of `ulna-source/1` (.toml), or a recording by its path. Raises UlnaInputError."""
    text = str(given)
    path = Path(text)
    if path.suffix.lower() == ".toml":
        return load_source(path)
    if isinstance(given, Path) or ":" not in text[:24] or path.is_file():
        from urllib.parse import quote

        text = f"file:{quote(text)}"
    url = Url.read(text)
    file = SourceFile(format="ulna-source/1", url=text)
    if url.scheme == "file":
        file = _kept(Path(url.path), file)
    return StatedSource(file, url, Path("source"), Path())


def _kept(path: Path, file: SourceFile) -> SourceFile:
    """What a journal keeps of its source holds for the recording too."""
    try:
        with path.open("rb") as stream:
            if stream.read(len(MAGIC)) != MAGIC:
                return file
    except OSError:
        return file  # whoever opens it says so
    source = Reading(path).head.get("source")
    if source is None:
        return file
    return fill(SourceFile, source, path).model_copy(update={"url": file.url, "decode": None})


def load_source(path: Path) -> StatedSource:
    """A source file. Raises UlnaInputError."""
    document, _ = read_toml(path, WHAT)
    check_format(document, path, "ulna-source")
    if "decode" in document:
        check_kind(document["decode"], "decode", tuple(DECODERS), path)
    file = fill(SourceFile, document, path)
    try:
        url = Url.read(file.url)
    except UlnaInputError as error:
        raise UlnaInputError(f"{path}: key 'url': {error}") from None
    if file.decode is not None:
        _check_decode(file.decode, path)
    _check_map(file, path)
    return StatedSource(file, url, path, path.parent)


def _check_decode(table: DecodeTable, path: Path) -> None:
    if table.names is not None:
        read = [name for name in table.names if name != "-"]
        twice = sorted({name for name in read if read.count(name) > 1})
        if twice:
            raise UlnaInputError(f"{path}: key 'decode.names': '{twice[0]}' is there twice. Name each once.")
        if len(read) > MOST_CHANNELS + 2:
            raise UlnaInputError(
                f"{path}: key 'decode.names': {len(read)} names; expected {MOST_CHANNELS} channels at most. Write "
                f'"-" for '
                "those that are not read."
            )
    if not isinstance(table, JsonTable):
        for key, name in (("time", table.time), ("button", table.button)):
            if name is not None and name not in (table.names or ()):
                raise UlnaInputError(
                    f"{path}: key 'decode.{key}': got '{name}', expected one of decode.names. Add it there."
                )
        if table.names is not None and not set(table.names) - {"-", table.time, table.button}:
            raise UlnaInputError(f"{path}: key 'decode.names': no channel among them; expected some. Add them.")
    if isinstance(table, BinaryTable):
        _check_struct(table, path)


def _check_struct(table: BinaryTable, path: Path) -> None:
    try:
        size = struct.calcsize(table.struct)
        numbers = struct.unpack(table.struct, bytes(size)) if size <= 4096 else ()
    except struct.error as error:
        raise UlnaInputError(
            f"{path}: key 'decode.struct': got '{table.struct}' ({error}); expected such as \"<I7f\". Correct it."
        ) from None
    if not numbers or len(numbers) > 4 * MOST_CHANNELS or any(isinstance(each, bytes) for each in numbers):
        raise UlnaInputError(
            f"{path}: key 'decode.struct': got '{table.struct}'; expected numbers, at most {4 * MOST_CHANNELS}, and no "
            'letters. "x" leaves out a byte.'
        )
    if table.names is not None and len(table.names) != len(numbers):
        raise UlnaInputError(
            f"{path}: key 'decode.names': {len(table.names)} names for {len(numbers)} numbers of decode.struct; "
            f"expected "
            'one for each. Write "-" for those that are not read.'
        )
    if table.names is None and len(numbers) > MOST_CHANNELS:
        raise UlnaInputError(
            f"{path}: key 'decode.names' is missing; expected names, as the struct has {len(numbers)} numbers and "
            f"{MOST_CHANNELS} are read at most. Add it."
        )


def _check_map(file: SourceFile, path: Path) -> None:
    names = file.map.channels
    if names is not None and len(set(names)) < len(names):
        raise UlnaInputError(f"{path}: key 'map.channels': a channel is there twice. Name each once.")
    counts = file.map.counts_per_turn
    if file.map.unit == "counts" and counts is None:
        raise UlnaInputError(
            f"{path}: key 'map.counts_per_turn' is missing; expected it with unit = \"counts\". Add it."
        )
    if counts is not None and file.map.unit != "counts":
        raise UlnaInputError(
            f"{path}: key 'map.counts_per_turn': expected it with unit = \"counts\" alone. Take it out, or correct "
            f"the unit."
        )
    if isinstance(counts, list) and names is not None and len(counts) != len(names):
        raise UlnaInputError(
            f"{path}: key 'map.counts_per_turn': {len(counts)} numbers for {len(names)} channels; expected one for "
            f"each."
        )
    if file.trigger.by == "button" and file.decode is not None and file.decode.button is None:
        raise UlnaInputError(
            f"{path}: key 'trigger.by': got 'button', but decode.button does not say which field that is. Add it."
        )


def _made(table: DecodeTable, midway: bool) -> Decoder:
    names = None if table.names is None else tuple(table.names)
    clock = {"time": table.time, "time_unit": table.time_unit, "button": table.button}
    match table:
        case FieldsTable():
            return Fields(table.separator, table.prefix, names, midway=midway, **clock)  # type: ignore[arg-type]
        case JsonTable():
            return JsonValues(table.values, table.joints, names, midway=midway, **clock)  # type: ignore[arg-type]
        case BinaryTable():
            sync = bytes.fromhex(table.sync or "")
            return Packets(table.struct, sync, table.checksum, names, **clock)  # type: ignore[arg-type]
    raise AssertionError(f"no decoder of {table.kind}")
