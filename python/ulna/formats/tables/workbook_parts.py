"""The parts of an Excel workbook, which is a zip archive: none is unpacked that is more than its file can be.

What an archive declares of its parts need not be so: Calamine unpacks a part to its end. A part that could be large is
gone through once, which takes some hundredths of the time that reading it takes.
"""

from __future__ import annotations

import zipfile
import zlib
from pathlib import Path

from ulna.formats.unpacked import check_unpacked, too_much

_CHUNK = 1 << 20
_MOST_TIMES = 1032
"""What zlib makes of a byte at best."""


def check_parts(path: Path, archive: zipfile.ZipFile) -> None:
    """Raises UlnaInputError for parts that are too large; BadZipFile, OSError or zlib.error for a damaged archive."""
    parts = archive.infolist()
    check_unpacked(path, sum(part.file_size for part in parts), "its parts")
    for part in parts:
        packed = part.compress_type == zipfile.ZIP_DEFLATED
        if packed and too_much(path, _MOST_TIMES * part.compress_size) and not _as_declared(path, archive, part):
            raise zipfile.BadZipFile(f"{part.filename} is larger than is said of it")


def _as_declared(path: Path, archive: zipfile.ZipFile, part: zipfile.ZipInfo) -> bool:
    """Whether a part ends within the size that is declared of it."""
    with path.open("rb") as stream:
        stream.seek(part.header_offset)
        head = stream.read(30)
        stream.seek(int.from_bytes(head[26:28], "little") + int.from_bytes(head[28:30], "little"), 1)
        unpacker, left, size = zlib.decompressobj(-zlib.MAX_WBITS), part.compress_size, 0
        while left > 0 and (chunk := stream.read(min(left, _CHUNK))):
            left -= len(chunk)
            while chunk and not unpacker.eof:
                size += len(unpacker.decompress(chunk, _CHUNK))
                chunk = unpacker.unconsumed_tail
                if size > part.file_size:
                    return False
    return True
