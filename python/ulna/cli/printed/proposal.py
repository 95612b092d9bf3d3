"""What `ulna new` prints: every column of the file with what it is taken for and why; how the rest was settled."""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import RenderableType
from rich.table import Table
from rich.text import Text

from ulna.ground.terminal import plain_table
from ulna.proposals.propose import Proposal


def proposal_report(proposal: Proposal) -> Iterator[RenderableType]:
    """The parts, in order."""
    yield from (Text(remark) for remark in dict.fromkeys(said for each in proposal.every for said in each.remarks))
    for each in proposal.every:
        whose = f" of '{each.stated.artefact.name}'" if proposal.others else ""
        grid = plain_table(f"{each.readings.name}: {each.rows} rows{whose}")
        for head in ("column", "taken for", "because"):
            grid.add_column(head, overflow="fold")
        for taken in each.taken:
            grid.add_row(Text(taken.column), Text(taken.ours or "not used"), Text(taken.why))
        yield grid
        yield Text("")
    said = Table.grid(padding=(0, 2, 0, 0))
    for what, how in _settled(proposal):
        said.add_row(Text(what), Text(how))
    yield said
    yield Text("")


def _settled(proposal: Proposal) -> Iterator[tuple[str, str]]:
    arm = proposal.arm
    yield "angles", f"{proposal.angle}: {proposal.angle_why}"
    for key in ("separator", "decimal"):
        if key in proposal.entry:
            yield key, f"'{proposal.entry[key]}'"
    yield "arm", f"{arm.n} axes, {proposal.drawn.said}"
    if proposal.search or arm.unknown_signs.any():
        unknown = ["zeros"] * proposal.search + ["signs"] * bool(arm.unknown_signs.any())
        yield "encoders", f"{' and '.join(unknown)} are not known: the calibration searches for them"
    for stated in {each.stated.artefact.name: each.stated for each in proposal.every}.values():
        dimensions = [
            f"{key} = {value}" for key, value in stated.keys.items() if key not in ("kind", "features_format")
        ]
        yield "touched", ", ".join([str(stated.keys["kind"]), *dimensions]) + f" ({stated.length_unit})"
    if any(set(each.entry.get("where", ())) - {"artefact"} for each in proposal.every):
        yield "left out", "rows in which an axis has no number"
    yield "far off", 'readings that do not fit count less (loss = "cauchy"), and calibrate names them'
