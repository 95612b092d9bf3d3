"""The rerun of Cheng 2011: every claim comes out, and the pictures and numbers are written whole or not at all."""

import csv
import json
import re
from io import StringIO

import numpy as np
import pytest
from pypdf import PdfReader
from rich.console import Console
from tests.oracle import published
from tests.oracle.core import core_arm

from ulna.ground.errors import UlnaInputError
from ulna.reproduce import STUDIES, cheng2011
from ulna.reproduce.cheng2011 import arms
from ulna.reproduce.cheng2011.convergence import WRONG_BY_RAD

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def rerun(tmp_path_factory):
    out = tmp_path_factory.mktemp("cheng") / "out"
    stages = []
    found = cheng2011.run(out, lambda *report: stages.append(report), starts=15, repeats=60)
    return found, out, stages


def test_every_claim_of_the_paper_comes_out(rerun):
    found, _, _ = rerun
    assert [claim.what for claim in found.claims() if claim.agrees is False] == []
    assert found.agrees
    assert len(found.claims()) == 3 + len(WRONG_BY_RAD) + 5


def test_the_page_shows_every_claim(rerun, root):
    """As it was printed with more starts: `make docs-output` writes it."""
    shown = (root / "docs" / "output" / "reproduce.txt").read_text(encoding="utf-8").lower()
    assert [claim.what for claim in rerun[0].claims() if claim.what[:12].lower() not in shown] == []


def test_the_tables_were_copied_without_a_slip():
    """Against the oracle's copy of the printed tables, written down a second time."""
    for r_mm in (0.0, 10.0):
        truth, start = arms.simulated(r_mm)
        np.testing.assert_array_equal(truth.parameters, core_arm(published.table_2(r_mm)).parameters)
        np.testing.assert_array_equal(start.parameters, core_arm(published.table_3(r_mm)).parameters)
    for probe, straight in ((arms.BENT_PROBE, False), (arms.STRAIGHT_PROBE, True)):
        np.testing.assert_array_equal(arms.platinum(probe).parameters, core_arm(published.table_4(straight)).parameters)


def test_the_virtual_experiment_is_a_fair_one(rerun):
    """What was found is off by what its uncertainty says, and fresh bars are nearly as good as noise allows."""
    experiment = rerun[0].experiment
    off = np.array([(row.found - row.truth) / row.u for row in experiment.parameters if row.u is not None])
    assert len(off) == 25
    assert 0.5 < np.sqrt((off**2).mean()) < 1.7
    assert [row.name for row in experiment.parameters if row.u is None] == ["joint.1.theta0", "joint.1.d"]
    for errors, best in (
        (experiment.bent_errors_mm, experiment.bent_errors_true_arm_mm),
        (experiment.straight_errors_mm, experiment.straight_errors_true_arm_mm),
    ):
        assert len(errors) == 10
        assert np.std(errors) < 3 * np.std(best) + 0.005
        assert min(map(abs, np.subtract(errors, best))) > 0  # not the same arm


def test_what_it_writes(rerun):
    found, out, stages = rerun
    pictures = [f"{name}.{form}" for name in ("bars", "convergence") for form in ("pdf", "png", "svg")]
    tables = [f"table-{number}.csv" for number in range(1, 6)]
    assert sorted(path.name for path in out.iterdir()) == sorted([*pictures, *tables, "cheng2011.json", "tables.tex"])
    written = json.loads((out / "cheng2011.json").read_text("utf-8"))
    assert written == json.loads(json.dumps(found.as_dict()))
    for name in ("bars", "convergence"):
        assert (out / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        assert "</svg>" in (out / f"{name}.svg").read_text("utf-8")
        assert len(PdfReader(out / f"{name}.pdf").pages) == 1
    with (out / "table-1.csv").open(encoding="utf-8", newline="") as file:
        heads, *rows = csv.reader(file)
    assert heads == ["what", "the paper", "ours", "agrees"]
    assert [row[0] for row in rows] == [claim.what for claim in found.of_simulation()]
    assert [row[2] for row in rows] == [claim.ours for claim in found.of_simulation()]
    latex = (out / "tables.tex").read_text("utf-8")
    assert latex.count(r"\begin{tabular}") == latex.count(r"\end{tabular}") == 5
    for line in (line for line in latex.splitlines() if line.endswith(r"\\")):
        assert not re.search(r"(?<!\\)[%#_]", line), line
    assert [done for stage, done, _ in stages if stage == "convergence"] == list(range(15 * len(WRONG_BY_RAD)))
    assert [done for stage, done, _ in stages if stage == "experiment"] == list(range(60))


def test_an_existing_result_is_kept_unless_forced(rerun):
    found, out, _ = rerun
    before = (out / "cheng2011.json").read_bytes()
    with pytest.raises(UlnaInputError, match="exists already"):
        found.save(out)
    found.save(out, force=True)
    assert (out / "cheng2011.json").read_bytes() == before


def test_it_fits_a_terminal_of_80_columns(rerun):
    printed = StringIO()
    Console(width=80, file=printed).print(rerun[0].table())
    text = printed.getvalue()
    assert "…" not in text.replace("… r, mm", "").replace("… h, mm", "")
    assert max(map(len, text.splitlines())) <= 80
    for word in ("Table 4", "joint.6.d", "probe.straight.h", "within ± 0.037 mm"):
        assert word in text


def test_the_registry_names_it():
    description, module = STUDIES["cheng2011"]
    assert module == cheng2011.__name__
    assert "2011" in description
