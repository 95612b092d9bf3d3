"""What is said on the whole, of each state, to what it applies and by which rule; or that nothing is said."""

from __future__ import annotations

from ulna.documents.content.acceptance import Whole, wholes
from ulna.documents.content.content import Content
from ulna.documents.languages.text import Style, Text
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, Tone, own
from ulna.verification.decision import DecisionRule
from ulna.verification.lifted import rule_of

#: verdict → how it is shown
STYLES: dict[str | None, Style] = {"pass": "pass", "fail": "fail", "undecided": "undecided", None: "none"}
TONES: dict[str | None, Tone] = {"pass": "good", "fail": "bad", "undecided": "missing", None: "missing"}


def decision(content: Content, words: Words) -> list[Block]:
    """Each state as found and as left by itself, then the rule."""
    found = content.verification
    if found is None:
        return [Paragraph(words("decision.none"))]
    page: list[Block] = []
    for whole in wholes(found.file):
        page += _whole(whole, words)
    if all(state.state != "as-found" for state in found.file.states):
        page.append(Paragraph(words("decision.no-as-found"), "note"))
    page.append(Paragraph(words("decision.applies", standard=found.file.profile.standard)))
    return [*page, Paragraph(rule(rule_of(found.file.decision), words))]


def rule(decided: DecisionRule, words: Words) -> Text:
    """In the manner of ISO 14253-1, its guard band named as JCGM 106 and ILAC-G8 do: w = r U."""
    r = own(f"{decided.part_of_expanded:.3g}")
    return words("rule", guard=words(f"guard.{decided.rule}", k=own(f"{decided.k:g}"), r=r))


def verdict(word: str | None, words: Words) -> Text:
    """pass, fail, undecided, or that there is none."""
    return words(f"conformity.{word or 'none'}")


def _whole(whole: Whole, words: Words) -> list[Block]:
    said = words("decision.whole", verdict=verdict(whole.verdict, words), state=words(f"state.{whole.state}"))
    page: list[Block] = [Paragraph(said, TONES[whole.verdict])]
    if whole.unmeasured or whole.silent:
        partial = words("decision.partial", unmeasured=whole.unmeasured, silent=whole.silent)
        page.append(Paragraph(partial, "missing"))
    return page
