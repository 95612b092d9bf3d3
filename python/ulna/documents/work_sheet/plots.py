"""The pictures of a work sheet: the arm with the artefact in all places, then some places at a time."""

from __future__ import annotations

from ulna.documents.content.standing import StandingArm
from ulna.documents.languages.said import Said
from ulna.documents.languages.words import Words
from ulna.documents.pdf import arm_plot, blocks
from ulna.documents.pdf.canvas import axes_of, labels, svg_of
from ulna.documents.pdf.text import line
from ulna.planning.outcome import Plan
from ulna.planning.plots import draw_stands, rows_of
from ulna.planning.standing_arm import arm_and_stands

WIDE_MM, HIGH_MM = 124.0, 92.0


def plots(plan: Plan, words: Words) -> list[blocks.Block]:
    """The arm at its first touch; from above and from the side, of so many stands that numbers can be read."""
    stands = plan.stands
    scene = arm_and_stands(plan.arm, plan.spec.probe, stands)
    drawn = StandingArm(scene, plan.q_rad[0, 0, 0], Said("sheet.plot-arm", {"step": (f"{scene.step_mm:g}",)}))
    found = [blocks.plot(arm_plot.arm(drawn), line(words.say(drawn.said), words.language))]
    base = labels(words)("sheet.base")
    for group in rows_of(stands):
        first, last = group[0].number, group[-1].number
        above = line(words("sheet.plot-above", first=first, last=last), words.language)
        side = line(words("sheet.plot-side", first=first, last=last), words.language)
        for seen, caption in (((0, 1), above), ((0, 2), side)):
            figure, axes = axes_of(WIDE_MM, HIGH_MM)
            draw_stands(axes, stands, group, seen, base)
            found.append(blocks.plot(svg_of(figure, words), caption))
    return [blocks.plots(found[:1], 2), *(blocks.plots(found[k : k + 2], 2) for k in range(1, len(found), 2))]
