"""A small reader of PDF files, for what tests must know: pages, their text, fonts and attached facts.

It knows what a PDF without encryption and object streams needs: objects, streams, page tree, text operators, ToUnicode
maps and replacement text (ISO 32000-1, 9.4, 9.10.3, 14.9.4). It shares no code with what wrote the file.
"""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass, field

#: a string of bytes: parentheses in it are escaped or balanced (7.3.4.2), here up to three deep
_LEVEL_3 = rb"\((?:\\.|[^\\()])*\)"
_LEVEL_2 = rb"\((?:\\.|[^\\()]|" + _LEVEL_3 + rb")*\)"
_STRING = rb"\((?:\\.|[^\\()]|" + _LEVEL_2 + rb")*\)"
_TOKEN = re.compile(
    rb"(?P<font>/[!-~]+?)\s+[-\d.]+\s+Tf"
    rb"|(?P<span>/Span\s*<</ActualText\s*(?:<(?P<hex>[0-9A-Fa-f]*)>|(?P<literal>" + _STRING + rb"))\s*>>\s*BDC)"
    rb"|(?P<open>/[A-Za-z0-9]+\s*(?:<<.*?>>)?\s*(?:BDC|BMC))"
    rb"|(?P<close>\bEMC\b)"
    rb"|(?P<string>" + _STRING + rb"|<[0-9A-Fa-f]*>)"
    rb"|(?P<move>\bTm\b|\bTd\b|\bT\*)",
    re.S,
)
_ESCAPES = {b"n": b"\n", b"r": b"\r", b"t": b"\t", b"b": b"\b", b"f": b"\f"}


@dataclass
class Pdf:
    """The objects of a file."""

    content: bytes
    objects: dict[int, bytes] = field(default_factory=dict)

    def __post_init__(self) -> None:
        assert self.content.startswith(b"%PDF-1.7")
        assert b"/ObjStm" not in self.content
        for found in re.finditer(rb"(?:^|\n)(\d+) 0 obj\n(.*?)\nendobj", self.content, re.S):
            self.objects[int(found[1])] = found[2]

    def stream(self, number: int) -> bytes:
        """The stream of an object, unpacked."""
        head, _, rest = self.objects[number].partition(b"stream\n")
        data = rest.rsplit(b"\nendstream", 1)[0]
        return zlib.decompress(data) if b"/FlateDecode" in head else data

    @property
    def pages(self) -> list[int]:
        """Numbers of the page objects, in order."""
        tree = next(body for body in self.objects.values() if body.startswith(b"<</Type/Pages"))
        kids = re.search(rb"/Kids\s*\[([^]]*)\]", tree)
        assert kids is not None
        return [int(number) for number in re.findall(rb"(\d+) 0 R", kids[1])]

    def _fonts(self, page: int) -> dict[bytes, dict[int, str]]:
        resources = self._referred(self.objects[page], rb"/Resources")
        found = re.search(rb"/Font\s*<<(.*?)>>", resources, re.S)
        names = re.findall(rb"(/[!-~]+?)\s+(\d+) 0 R", found[1]) if found else []
        return {name: self._to_unicode(int(number)) for name, number in names}

    def _referred(self, body: bytes, key: bytes) -> bytes:
        number = re.search(key + rb"\s+(\d+) 0 R", body)
        assert number is not None
        return self.objects[int(number[1])]

    def _to_unicode(self, font: int) -> dict[int, str]:
        number = re.search(rb"/ToUnicode\s+(\d+) 0 R", self.objects[font])
        assert number is not None
        table = self.stream(int(number[1]))
        found: dict[int, str] = {}
        for block in re.findall(rb"beginbfchar(.*?)endbfchar", table, re.S):
            for code, text in re.findall(rb"<([0-9A-Fa-f]+)>\s*<([0-9A-Fa-f]+)>", block):
                found[int(code, 16)] = bytes.fromhex(text.decode()).decode("utf-16-be")
        assert b"beginbfrange" not in table
        return found

    def text(self, page: int) -> str:
        """Of one page: runs as they are written, one to a line."""
        content = re.search(rb"/Contents\s+(\d+) 0 R", self.objects[page])
        assert content is not None
        fonts = self._fonts(page)
        words: list[str] = []
        current: dict[int, str] = {}
        replaced: list[bool] = []
        for token in _TOKEN.finditer(self.stream(int(content[1]))):
            if token["font"] is not None:
                current = fonts[token["font"]]
            elif token["span"] is not None:
                replaced.append(True)
                words.append(_actual(token["hex"], token["literal"]))
            elif token["open"] is not None:
                replaced.append(False)
            elif token["close"] is not None:
                replaced.pop()
            elif token["move"] is not None:
                words.append("\n")
            elif not any(replaced):
                codes = _bytes(token["string"])
                words += [current[int.from_bytes(codes[k : k + 2])] for k in range(0, len(codes), 2)]
        return re.sub("\n+", "\n", "".join(words))

    @property
    def texts(self) -> list[str]:
        """Of each page."""
        return [self.text(page) for page in self.pages]


def _bytes(token: bytes) -> bytes:
    if token.startswith(b"<"):
        return bytes.fromhex(token[1:-1].decode())

    def plain(found: re.Match[bytes]) -> bytes:
        given = found[1]
        return bytes([int(given, 8)]) if given.isdigit() else _ESCAPES.get(given, given)

    return re.sub(rb"\\([0-7]{1,3}|.)", plain, token[1:-1], flags=re.S)


def _actual(given: bytes | None, literal: bytes | None) -> str:
    data = bytes.fromhex(given.decode()) if given is not None else _bytes(literal or b"()")
    return data[2:].decode("utf-16-be") if data.startswith(b"\xfe\xff") else data.decode("latin-1")


def squeezed(text: str) -> str:
    """Without white space, marks of direction and places to break a word: what is left is what is read."""
    return re.sub("[\\s\u00ad\u200b\u2066-\u2069]+", "", text)
