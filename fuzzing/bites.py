"""Bytes spoilt: flipped, cut, spliced, said twice; lines and words of texts likewise."""

from __future__ import annotations

from random import Random

from fuzzing.values import NUMBERS, TEXTS


def spoilt_bytes(content: bytes, source: Random) -> bytes:
    """A file as a bad disk or a hasty copy leaves it."""
    found = bytearray(content)
    for _ in range(source.choice([1, 1, 2, 5])):
        if not found:
            break
        at, length = source.randrange(len(found)), source.choice([1, 1, 2, 4, 16, 200])
        way = source.randrange(7)
        if way == 0:
            found[at] ^= 1 << source.randrange(8)
        elif way == 1:
            found[at : at + length] = bytes(source.randrange(256) for _ in range(min(length, 16)))
        elif way == 2:
            del found[at : at + length]
        elif way == 3:
            found[at:at] = found[at : at + length]
        elif way == 4:
            del found[at:]
        elif way == 5:
            to = source.randrange(len(found))
            found[to:to] = found[at : at + length]
        else:
            found[at : at + length] = source.choice([b"\x00", b"\xff", b"\x7f\xff", b"\x80"]) * min(length, 8)
    return bytes(found)


def spoilt_text(content: bytes, source: Random) -> bytes:
    """A text as somebody edits it in haste: lines, words and signs."""
    lines = content.split(b"\n")
    for _ in range(source.choice([1, 1, 2, 4])):
        at = source.randrange(len(lines))
        way = source.randrange(6)
        if way == 0:
            del lines[at]
            lines = lines or [b""]
        elif way == 1:
            lines.insert(source.randrange(len(lines) + 1), lines[at])
        elif way == 2:
            other = source.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        elif way == 3:
            words = lines[at].split(b" ")
            words[source.randrange(len(words))] = _word(source)
            lines[at] = b" ".join(words)
        elif way == 4:
            lines[at] = spoilt_bytes(lines[at], source)
        else:
            lines[at : at + 2] = [b"".join(lines[at : at + 2])]
    return b"\n".join(lines)


def _word(source: Random) -> bytes:
    return str(source.choice([*NUMBERS, *TEXTS])).encode("utf-8", "surrogatepass")
