"""What the docs show is what the program prints today, so that nobody reads yesterday's output."""

import importlib
import re
import sys

import pytest
from tests.showing import same


@pytest.fixture(scope="module")
def tools(root):
    """The modules in tools/, which are no package."""
    sys.path.insert(0, str(root / "tools"))
    try:
        yield {
            name: importlib.import_module(name)
            for name in (
                *("docs_arm_pictures", "docs_output", "docs_errors", "docs_evening", "docs_real_readings"),
                "docs_records",
            )
        }
    finally:
        sys.path.remove(str(root / "tools"))


def test_the_comparison_sees_what_it_should():
    assert same("rms  0.0105 mm", "rms 0.01051 mm") == []
    assert same("rms 0.0105 mm", "rms 0.0205 mm") != []
    assert same("rms 0.0105 mm", "max 0.0105 mm") != []
    assert same("one line", "one line\nanother") != []


@pytest.mark.long
@pytest.mark.timeout(900)  # it runs all that the pages show
def test_outputs_of_commands(root, tools):
    """What a clock or a thousand fits is in has a test of its own."""
    printed = tools["docs_output"].command_outputs(slow=False)
    shown = {path.name for path in (root / "docs" / "output").glob("*.txt")}
    of_the_year = {name for _, name, _ in tools["docs_records"].YEAR if name}
    others = {*tools["docs_output"].WAYS, *tools["docs_output"].SLOW, *tools["docs_evening"].FILES}
    assert shown == set(printed) | others | of_the_year
    for name, text in printed.items():
        assert same((root / "docs" / "output" / name).read_text(encoding="utf-8"), text) == [], name


@pytest.mark.timeout(900)  # a whole year
def test_the_laboratory_s_year(root, tools):
    for name, text in tools["docs_records"].year_outputs().items():
        assert same((root / "docs" / "output" / name).read_text(encoding="utf-8"), text) == [], name


def test_messages_on_the_errors_page(root, tools):
    shown = (root / "docs" / "output" / "errors.md").read_text(encoding="utf-8")
    assert same(shown, tools["docs_errors"].error_page()) == []


@pytest.mark.long
@pytest.mark.timeout(900)  # it runs all that the pages show
def test_tables_of_real_readings(root, tools, shared_data):
    """Those that take seconds; the long ones are made by `make docs-output`, from the same studies."""
    for name, table in tools["docs_real_readings"].real_readings_tables(long=False).items():
        assert same((root / "docs" / "output" / f"real-{name}.md").read_text(encoding="utf-8"), table) == [], name


def test_readme_shows_what_is_printed(root, tools):
    readme = (root / "README.md").read_text(encoding="utf-8")
    assert tools["docs_output"].filled_readme(readme) == readme, "run `make docs-output`"


def test_every_generated_output_is_shown(root):
    pages = "\n".join(path.read_text(encoding="utf-8") for path in (root / "docs").rglob("*.md"))
    for path in [*(root / "docs" / "output").iterdir(), *(root / "docs" / "examples" / "output").iterdir()]:
        assert str(path.relative_to(root)) in pages, f"{path.name} is made but not shown"


def test_pictures_of_arms(root, tools):
    """Numbers of paths apart, which other processors round otherwise, they are what is drawn today."""
    for name, text in tools["docs_arm_pictures"].arm_pictures().items():
        shown = (root / "docs" / "pictures" / name).read_text(encoding="utf-8")
        assert len(shown.splitlines()) == len(text.splitlines()), name
        numbers = [[float(each) for each in re.findall(r"-?\d+\.?\d*", each)] for each in (shown, text)]
        assert numbers[0] == pytest.approx(numbers[1], abs=0.11), f"{name}: run tools/docs_arm_pictures.py"
