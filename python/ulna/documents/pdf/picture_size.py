"""How large a picture says it is: pictures are unpacked to print them, and a small file may declare any size.

PNG: ISO/IEC 15948, 11.2.2 (IHDR). GIF: GIF89a, 18 (logical screen) and 20 (image). JPEG: ISO/IEC 10918-1, B.2.2 (frame
header). WebP: RFC 9649, 2.5 to 2.7.
"""

from __future__ import annotations

MOST_PIXELS = 25_000_000
"""A letterhead of 20 cm by 10 cm with 900 dots an inch; 100 MB unpacked."""


def pixels(picture: bytes) -> int | None:
    """Of a PNG, JPEG, GIF or WebP picture, as it says itself; None of any other, or where it does not say."""
    for begin, read in _KINDS.items():
        if picture.startswith(begin):
            return read(picture)
    return None


def _png(picture: bytes) -> int | None:
    return _product(picture, 16, 4, "big") if picture[12:16] == b"IHDR" else None


def _gif(picture: bytes) -> int | None:
    return _product(picture, 6, 2, "little")


def _webp(picture: bytes) -> int | None:
    kind = picture[12:16]
    if kind == b"VP8X":
        return (_number(picture, 24, 3, "little") + 1) * (_number(picture, 27, 3, "little") + 1)
    if kind == b"VP8L":
        bits = _number(picture, 21, 4, "little")
        return ((bits & 0x3FFF) + 1) * ((bits >> 14 & 0x3FFF) + 1)
    if kind == b"VP8 ":
        return (_number(picture, 26, 2, "little") & 0x3FFF) * (_number(picture, 28, 2, "little") & 0x3FFF)
    return None


def _jpeg(picture: bytes) -> int | None:
    at = 2
    while at + 9 <= len(picture) and picture[at] == 0xFF:
        marker, length = picture[at + 1], _number(picture, at + 2, 2, "big")
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            return _product(picture, at + 5, 2, "big")
        at += 1 if marker == 0xFF else 2 + length  # fill bytes before a marker
    return None


def _product(picture: bytes, at: int, width: int, order: str) -> int:
    return _number(picture, at, width, order) * _number(picture, at + width, width, order)


def _number(picture: bytes, at: int, width: int, order: str) -> int:
    return int.from_bytes(picture[at : at + width], "big" if order == "big" else "little")


_KINDS = {b"\x89PNG\r\n\x1a\n": _png, b"\xff\xd8": _jpeg, b"GIF8": _gif, b"RIFF": _webp}
