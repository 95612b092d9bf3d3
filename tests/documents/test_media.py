"""Page and paper say the same: every table on paper is one of the page's, cell by cell, and so is every sentence."""

from __future__ import annotations

import html
import re
from pathlib import Path
from typing import Any, get_args

import pytest
from tests.acceptance import write_plan
from tests.cli_runs import run, write_lengths
from tests.reports import HOSTILE, calibrated, seats_study

from ulna.documents.content.content import Content
from ulna.documents.gather import gather
from ulna.documents.html.blocks import LOOKS, MACROS, TONES
from ulna.documents.html.drawings import DRAWN as ON_PAGE
from ulna.documents.html.page import render
from ulna.documents.languages.text import plain
from ulna.documents.languages.words import Words
from ulna.documents.pdf import setting
from ulna.documents.pdf.drawings import DRAWN as ON_PAPER
from ulna.documents.pdf.layout import LAYOUTS
from ulna.documents.pdf.order import annexed, parts
from ulna.documents.pdf.render import certificate
from ulna.documents.pdf.text import decimals
from ulna.documents.sections.blocks import Block, Table, Tiles, Tone

Rows = list[dict[str, str]]


@pytest.fixture(scope="module")
def contents(tmp_path_factory: pytest.TempPathFactory, root: Path) -> list[Content]:
    """Lengths with everything beside them, and touches with hostile names and an outlier."""
    folder = tmp_path_factory.mktemp("media")
    write_plan(folder)
    done = run("verify", folder / "plan.toml", "-o", folder / "tested")
    assert done.returncode in (0, 1), done.stderr
    lengths = calibrated(write_lengths(folder / "lengths"))
    lab = root / "examples" / "platinum" / "laboratory.toml"
    seats = calibrated(seats_study(folder / "seats", HOSTILE, more='loss = "huber"\n'))
    verified = folder / "tested" / "verification.json"
    return [gather(lengths, laboratory=lab, verified=verified), gather(seats)]


def bare(text: str) -> str:
    """Without what only a medium needs: marks of direction, places to break, elements."""
    return " ".join(re.sub("[\u2066-\u2069\u200b]", "", text).replace("\ufffd", "").split())


def of_page(text: str) -> list[Rows]:
    """Its tables, each row by its heads."""
    found = []
    for table in re.findall(r"<table>(.*?)</table>", text, flags=re.S):
        heads = [cell(each) for each in re.findall(r"<th[^>]*>(.*?)</th>", table, flags=re.S)]
        rows = [re.findall(r"<td[^>]*>(.*?)</td>", row, flags=re.S) for row in re.findall(r"<tr>.*?</tr>", table, re.S)]
        found.append([dict(zip(heads, map(cell, row), strict=True)) for row in rows if row])
    return found


def cell(text: str) -> str:
    return re.sub("[\u202a-\u202e]", "", bare(html.unescape(re.sub(r"<[^>]+>", "", text))))


def said(value: Any) -> str:
    """A cell on paper, whatever its style."""
    if isinstance(value, list):
        return "".join(map(said, value))
    return value if isinstance(value, str) else str(value["text"])


@pytest.mark.parametrize("language", ["en", "de"])
def test_every_table_on_paper_is_on_the_page_cell_by_cell(contents: list[Content], language: str) -> None:
    compared = 0
    for content in contents:
        on_page = [
            [{head: decimals(text, language) for head, text in row.items()} for row in each]
            for each in of_page(render(content, language))
        ]
        data, _ = certificate(content, language)
        for table in (block for block in [*data["blocks"], *data["annex"]] if block["kind"] == "table"):
            heads = [bare(head) for head in table["heads"]]
            rows = [dict(zip(heads, (bare(said(each)) for each in row), strict=True)) for row in table["rows"]]
            same = [
                each
                for each in on_page
                if each and set(heads) <= set(each[0]) and [{head: row[head] for head in heads} for row in each] == rows
            ]
            assert same, heads
            compared += 1
    assert compared >= 12


@pytest.mark.parametrize("language", ["en", "de"])
def test_sections_that_both_have_say_the_same_sentences(contents: list[Content], language: str) -> None:
    compared = 0
    for content in contents:
        text = render(content, language)
        page = cell(re.sub(r"</(p|li|h3)>", " ", text.split("<main>")[1].split("</main>")[0]))
        headings = {cell(each) for each in re.findall(r"<h2>(.*?)</h2>", text)}
        words = Words(language)
        legend = plain(words("paper.cloud-legend"))  # of plots; a page shows it in colours
        for part in [*parts(content, words, annex=True), *annexed(content, words)]:
            if plain(part.heading) not in headings:
                continue
            for sentences in (plain(getattr(block, "text", ())) for block in part.blocks):
                shown = bare(sentences.replace(legend, ""))
                assert re.sub("[\u202a-\u202e]", "", shown) in page, sentences
                compared += bool(shown)
    assert compared >= 20


def test_both_media_know_every_kind_of_block_and_tone() -> None:
    kinds = set(get_args(Block))
    assert kinds <= set(MACROS)
    assert kinds - set(setting._SET) == {Tiles}, "key figures are on the page alone"
    assert set(get_args(Tone)) == set(TONES) == set(setting.STYLES)


def test_every_table_has_its_looks_and_its_widths(contents: list[Content]) -> None:
    assert set(LAYOUTS) <= set(LOOKS)
    for content in contents:
        for part in [*parts(content, Words("en"), annex=True), *annexed(content, Words("en"))]:
            for block in part.blocks:
                if isinstance(block, Table):
                    kept = block.only(LAYOUTS[block.name].widths)
                    assert kept.columns, block.name
                    assert len(kept.heads) == len(kept.columns)
                    assert all(len(row) == len(kept.columns) for row in kept.rows)


def test_every_plot_is_drawn_by_one_of_them_at_least() -> None:
    both = {"arm", "histogram", "quantiles", "cloud", "lengths", "tested-lengths"}
    assert set(ON_PAGE) & set(ON_PAPER) == both
    with pytest.raises(KeyError, match="nonsense"):
        ON_PAPER["nonsense"]
