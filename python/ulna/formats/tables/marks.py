"""The first bytes by which files of a format are told."""

from __future__ import annotations

from ulna.formats.encodings import utf16

PARQUET = b"PAR1"
ZIP = b"PK\x03\x04"
OLD_OFFICE = b"\xd0\xcf\x11\xe0"
"""Of Microsoft's programs until 2003, and of what has a password."""

_HDF5 = b"\x89HDF\r\n\x1a\n"
#: a file may begin with a block of somebody else's, of one of these lengths; MATLAB writes 512 bytes
_HDF5_OFFSETS = (0, 512, 1024, 2048, 4096, 8192, 16384, 32768)


def is_hdf5(start: bytes) -> bool:
    """Whether a file that begins so is HDF5."""
    return any(start.startswith(_HDF5, offset) for offset in _HDF5_OFFSETS)


def is_mat(start: bytes) -> bool:
    """The same of MAT files up to version 7: version and byte order come after 124 bytes of text."""
    return start[124:128] in (b"\x00\x01IM", b"\x01\x00MI")


def is_text(start: bytes) -> bool:
    """The same of text: UTF-16 is, and a text behind which zeros fill a block."""
    return b"\x00" not in start.rstrip(b"\x00") or utf16(start) is not None
