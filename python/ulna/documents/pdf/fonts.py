"""Fonts for what a page says: free ones that come with the program's packages, then what the machine has.

Libertinus Serif is part of Typst, DejaVu Sans (Latin, Greek, Cyrillic, Arabic, Hebrew, signs) of Matplotlib; both are
free, both are there on every machine. Every character must be one of DejaVu Sans, or another font is looked for: in
the folder that the user names, in the package `pylopdf-fonts-zh-cn` (the extra `chinese`), on the system. A character
that no font has is an error; an empty box is never printed.
"""

from __future__ import annotations

import importlib.util
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib as mpl

from ulna.documents.languages.languages import language_of
from ulna.ground.errors import UlnaInputError

LETTERS = "Libertinus Serif"
SIGNS = "DejaVu Sans"
_OURS = ("DejaVuSans.ttf", "DejaVuSans-Bold.ttf", "DejaVuSans-Oblique.ttf")
#: families that are asked first, all of them with simplified Chinese
CHINESE = (
    "Noto Serif SC",
    "Noto Serif CJK SC",
    "Source Han Serif SC",
    "Noto Sans SC",
    "Noto Sans CJK SC",
    "Source Han Sans SC",
    "Songti SC",
    "PingFang SC",
    "SimSun",
    "Microsoft YaHei",
    "WenQuanYi Micro Hei",
    "WenQuanYi Zen Hei",
    "Droid Sans Fallback",
)
_CHINESE_PACKAGE = "pylopdf_fonts_zh_cn"


@dataclass(frozen=True)
class Family:
    """A family of fonts that is wanted besides the two."""

    name: str
    files: tuple[Path, ...]
    """All its styles."""
    regular: Path
    """The one whose characters were looked at."""


@dataclass(frozen=True)
class Chosen:
    """The fonts of one document."""

    more: list[Family]

    @property
    def files(self) -> list[Path]:
        """All font files that Typst has to see."""
        return [*_our_files(), *(file for family in self.more for file in family.files)]

    def order(self, language: str) -> list[dict[str, Any]]:
        """Families in the order in which they are asked for a character; `letters`: only for letters and digits.

        Where the language is written in Han signs, their font comes second, so that quotation marks and dashes are as
        wide as they are there.
        """
        han = language_of(language).han
        more = [{"name": family.name, "letters": False} for family in self.more]
        own = [{"name": LETTERS, "letters": han}, {"name": SIGNS, "letters": False}]
        return [own[0], *more, own[1]] if han else [*own, *more]


def choose(text: Iterable[str], folder: Path | None = None) -> Chosen:
    """Fonts that have every character of the text. Raises UlnaInputError where there are none.

    folder: the user's own fonts, looked at before the others.
    """
    if folder is not None and not folder.is_dir():
        raise UlnaInputError(f"option --fonts: {folder} is no folder; expected one with font files. Correct it.")
    needed = {sign for each in text for sign in each if not _unseen(sign)}
    missing = needed - {chr(code) for code in _characters(_our_files()[0], 0)}
    more: list[Family] = []
    for places, system in (([] if folder is None else [folder], False), (_package(), False), ([], True)):
        if missing and (places or system):
            found, missing = _take(missing, _families(tuple(places), system))
            more += found
    if missing:
        raise UlnaInputError(_what_is_missing(missing))
    return Chosen(more)


def _our_files() -> list[Path]:
    return [Path(mpl.get_data_path()) / "fonts" / "ttf" / file for file in _OURS]


def _unseen(sign: str) -> bool:
    """Controls and spaces, which draw nothing: no font needs to have them."""
    return unicodedata.category(sign) in ("Cf", "Cc", "Zs", "Zl", "Zp")


@cache
def _characters(path: Path, index: int) -> frozenset[int]:
    """Code points of a font file; none where it cannot be read."""
    from fontTools.ttLib import TTFont, TTLibError

    try:
        with TTFont(path, fontNumber=index, lazy=True) as font:
            return frozenset(font.getBestCmap() or ())
    except (TTLibError, OSError, KeyError, AssertionError, ValueError):
        return frozenset()


def _package() -> list[Path]:
    """The folder of the optional package with Chinese fonts, which is not run for this."""
    found = importlib.util.find_spec(_CHINESE_PACKAGE)
    return [Path(each) for each in found.submodule_search_locations or ()] if found is not None else []


def _families(places: tuple[Path, ...], system: bool) -> list[tuple[Family, int]]:
    """Families with the index of their regular style in its file: those known to have Chinese first."""
    import typst

    fonts = typst.Fonts(
        include_system_fonts=system, include_embedded_fonts=False, font_paths=[str(place) for place in places]
    )
    of: dict[str, list[Any]] = {}
    for each in fonts.fonts():
        if each.path is not None:
            of.setdefault(each.family, []).append(each)
    ranked = sorted(of, key=lambda family: (CHINESE.index(family) if family in CHINESE else len(CHINESE), family))
    families = []
    for family in ranked:
        styles = sorted(of[family], key=lambda each: (each.style != "normal", abs(each.weight - 400), str(each.path)))
        files = tuple(dict.fromkeys(Path(each.path) for each in styles))
        families.append((Family(family, files, files[0]), int(styles[0].index)))
    return families


def _take(missing: set[str], families: Sequence[tuple[Family, int]]) -> tuple[list[Family], set[str]]:
    """Families until nothing is missing, each time the one that has most; and what is missing still."""
    taken: list[Family] = []
    while missing:
        best, most = None, 0
        for family, index in families:
            have = sum(ord(sign) in _characters(family.regular, index) for sign in missing)
            if have > most:
                best, most = (family, index), have
                if have == len(missing):
                    break
        if best is None:
            break
        taken.append(best[0])
        missing = {sign for sign in missing if ord(sign) not in _characters(best[0].regular, best[1])}
    return taken, missing


def _what_is_missing(missing: set[str]) -> str:
    signs = sorted(missing)
    shown = " ".join(f"{sign} (U+{ord(sign):04X})" for sign in signs[:8])
    more = f" and {len(signs) - 8} more" if len(signs) > 8 else ""
    if any(
        "\u2e80" <= sign <= "\u9fff" or "\uf900" <= sign <= "\ufaff" or "\uff00" <= sign <= "\uffef" for sign in signs
    ):
        remedy = (
            "Install a Chinese font, such as the free Noto CJK (Debian, Ubuntu: fonts-noto-cjk; any system: "
            'pip install "ulna[chinese]")'
        )
    else:
        remedy = "Install a font that has them, such as the free Noto fonts (Debian, Ubuntu: fonts-noto)"
    return (
        f"PDF: no font on this machine has {shown}{more}; an empty box is never printed. {remedy}, or name a folder "
        "with such a font by --fonts."
    )
