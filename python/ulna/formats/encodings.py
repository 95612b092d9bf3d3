"""In which letters a text is written: stated, or recognised where the bytes leave no doubt.

UTF-8 and UTF-16 tell themselves. Of others two are told by what they look like: Western European text (Windows-1252)
has letters such as ö or ° between ASCII, one and now and then two together; Chinese text (GBK) has its commonest
characters in pairs of bytes. What looks like neither is asked about, and shown as it would read.
"""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from ulna.ground.errors import UlnaInputError

WESTERN = "ÄÖÜäöüßàáâãåæçèéêëìíîïñòóôõøùúûýÀÁÂÃÅÆÇÈÉÊËÌÍÎÏÑÒÓÔÕØÙÚÛ°µ±²³·«»§’–"
ASKED = ("cp1252", "gbk", "cp1251", "shift_jis", "big5", "euc_kr", "cp1250")
"""What is shown of a text that nobody recognises."""
_SHOWN = 24


def known(name: str) -> bool:
    """Whether there is an encoding of this name, one of texts."""
    try:
        return codecs.lookup(name)._is_text_encoding
    except LookupError:
        return False


def utf16(start: bytes) -> str | None:
    """The UTF-16 that a file with these first bytes is: by its mark, or by the zeros of ASCII in it."""
    if start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    pairs = start[: len(start) & ~1][:4096]
    low, high = pairs[::2], pairs[1::2]
    if len(low) >= 8 and high.count(0) > 0.7 * len(high) and 0 not in low:
        return "utf-16-le"
    if len(low) >= 8 and low.count(0) > 0.7 * len(low) and 0 not in high:
        return "utf-16-be"
    return None


def decoded(path: Path, content: bytes, what: str, stated: str | None, say: str) -> tuple[str, str | None]:
    """The text of a file, and the encoding where it was recognised. say: how the encoding is stated.

    Raises UlnaInputError for what is not written so, or not recognised.
    """
    if stated is not None:
        try:
            return content.decode("utf-8-sig" if codecs.lookup(stated).name == "utf-8" else stated), None
        except UnicodeError as error:
            line = content.count(b"\n", 0, getattr(error, "start", 0)) + 1
            raise UlnaInputError(
                f"{path}: line {line} is not {stated} text; expected a text as it is said "
                f"to be. Correct {say.partition(' in ')[0]}."
            ) from None
    found = utf16(content)
    if found is None:
        try:
            return content.decode("utf-8-sig"), None
        except UnicodeDecodeError:
            found = _recognised(content)
    if found is None:
        raise UlnaInputError(_asking(path, content, what, say))
    try:
        return content.decode(found).removeprefix("\ufeff"), found
    except UnicodeError as error:
        raise UlnaInputError(
            f"{path}: looks like {found} text, but is none from byte {getattr(error, 'start', 0) + 1} on; expected "
            f"{what}. The file is damaged, or written otherwise: say {say}, or whichever it is, or save it as UTF-8."
        ) from None


def sample(content: bytes, encoding: str) -> str | None:
    """A piece of a text around its first letters that are no ASCII, as an encoding reads it; None where it cannot."""
    for line in content.splitlines():
        for cell in re.split(rb"[,;\t|]", line):
            if not cell.isascii():
                try:
                    text = cell.decode(encoding).strip()
                except UnicodeError:
                    return None
                return text[:_SHOWN] if text.isprintable() else None
    return None


def _recognised(content: bytes) -> str | None:
    runs = re.findall(rb"[\x80-\xff]+", content)
    try:
        single = min(map(len, runs)) == 1 and max(map(len, runs)) <= 3
        if single and set(b"".join(runs).decode("cp1252")) <= set(WESTERN):
            return "cp1252"
    except UnicodeError:
        return None
    pairs = [(run[k], run[k + 1]) for run in runs if len(run) % 2 == 0 for k in range(0, len(run), 2)]
    even = all(len(run) % 2 == 0 for run in runs)
    if even and all((0xA1 <= a <= 0xA3 or 0xB0 <= a <= 0xD7) and b >= 0xA1 for a, b in pairs) and len(set(pairs)) > 1:
        return "gbk"
    return None


def _asking(path: Path, content: bytes, what: str, say: str) -> str:
    at = next(k for k, line in enumerate(content.split(b"\n"), start=1) if not _is_utf8(line))
    line = content.split(b"\n")[at - 1]
    read = [(name, sample(line, name)) for name in ASKED]
    shown = ", ".join(f"as {name} it reads '{text}'" for name, text in read if text)
    shown = f"{shown[0].upper()}{shown[1:]}. " if shown else ""
    return (
        f"{path}: line {at} is not UTF-8 text; expected {what} in UTF-8, or to be told its letters. {shown}Say {say}, "
        "or whichever it is, or save the file as UTF-8."
    )


def _is_utf8(line: bytes) -> bool:
    try:
        line.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return True
