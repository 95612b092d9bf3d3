"""Imports run one way, in Python and in Rust, so that every room can be understood without the rooms above it."""

import ast
import re
import subprocess
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

import pytest

#: every room of python/ulna on its own floor: a file may import from its own room and from rooms on lower floors.
#: The public face (`__init__.py`) is asked by nobody inside; `_core` is the compiled core.
FLOORS = {
    "_core": 0,
    "ground": 1,
    "work": 2,
    "formats": 2,
    "geometry": 2,
    "arm": 3,
    "artefacts": 4,
    "exchange": 4,
    "study": 5,
    "measuring": 6,
    "simulation": 6,
    "calibration": 6,
    "verification": 7,
    "planning": 7,
    "reproduce": 7,
    "uncertainties": 8,
    "documents": 9,
    "cli": 10,
    "__main__": 11,
}

#: Rust modules of the core that know no kinematics
BLIND = ("solver", "covariance", "numdiff")
RUST_ORDER = ["arm", "kinematics", "residuals", "problem", "calibrate"]


def modules(root: Path) -> dict[str, Path]:
    """Dotted name → file, of all of python/ulna."""
    package = root / "python" / "ulna"
    found = {}
    for path in package.rglob("*.py"):
        parts = ("ulna", *path.relative_to(package).with_suffix("").parts)
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported(tree: ast.AST, known: Iterable[str]) -> list[tuple[str, int]]:
    """(module, line) of every import of ulna: at the top, inside a function, or for type checking only."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == "ulna":
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                found.append((full if full in known else node.module, node.lineno))
        elif isinstance(node, ast.Import):
            found += [(alias.name, node.lineno) for alias in node.names if alias.name.split(".")[0] == "ulna"]
    return found


def arrows(root: Path) -> dict[str, list[tuple[str, int]]]:
    """Who imports whom; the public face, which loads by name, is not asked."""
    known = modules(root)
    return {
        name: imported(ast.parse(path.read_text(encoding="utf-8")), known)
        for name, path in known.items()
        if name != "ulna"
    }


def room_of(module: str) -> str:
    return module.split(".")[1] if "." in module else "ulna"


def test_every_python_room_has_a_floor(root):
    rooms = {room_of(name) for name in modules(root)} - {"ulna"}
    assert rooms == set(FLOORS) - {"_core"}, "give each room its floor in FLOORS, and take out those that are gone"


def test_nothing_lies_flat_but_the_face_and_the_entry(root):
    flat = {path.name for path in (root / "python" / "ulna").iterdir() if path.suffix in {".py", ".pyi"}}
    assert flat <= {"__init__.py", "__init__.pyi", "__main__.py", "_core.pyi"}


def test_python_imports_run_down(root):
    wrong = []
    for name, targets in arrows(root).items():
        for target, line in targets:
            here, there = room_of(name), room_of(target)
            if there == "ulna":
                wrong.append(f"{name}:{line} asks the public face")
            elif here != there and FLOORS[there] >= FLOORS[here]:
                wrong.append(f"{name}:{line} imports {target} from floor {FLOORS[there]}, not below {FLOORS[here]}")
    assert wrong == []


def circle_in(edges: Mapping[str, Iterable[str]]) -> list[str]:
    """Some circle of a graph, or []."""
    done: set[str] = set()

    def visit(name: str, trail: tuple[str, ...]) -> list[str]:
        if name in trail:
            return [*trail[trail.index(name) :], name]
        if name in done:
            return []
        for target in edges.get(name, ()):
            found = visit(target, (*trail, name))
            if found:
                return found
        done.add(name)
        return []

    return next(filter(None, (visit(name, ()) for name in edges)), [])


def test_no_files_import_each_other_in_a_circle(root):
    circle = circle_in({name: [target for target, _ in targets] for name, targets in arrows(root).items()})
    assert circle == [], " → ".join(circle)


def test_the_checks_see_what_they_should():
    source = (
        "from ulna.cli import output\ndef f():\n    import ulna.documents.write\n"
        "if TYPE_CHECKING:\n    from ulna.study.study import Study\n"
    )
    known = ["ulna.cli", "ulna.cli.output", "ulna.documents.write", "ulna.study.study"]
    assert imported(ast.parse(source), known) == [
        ("ulna.cli.output", 1),
        ("ulna.documents.write", 3),
        ("ulna.study.study", 5),
    ]
    assert circle_in({"a": ["b"], "b": ["c"], "c": ["a"]}) == ["a", "b", "c", "a"]
    assert circle_in({"a": ["b", "c"], "b": ["c"]}) == []


def rust_rooms(root: Path) -> list[tuple[str, Path]]:
    source = root / "crates" / "ulna" / "src"
    return sorted((path.relative_to(source).with_suffix("").parts[0], path) for path in source.rglob("*.rs"))


def rust_uses(text: str) -> set[str]:
    """Modules of the core that a file names as `crate::…`, tests and comments left out."""
    code = re.sub(r"//[^\n]*", "", text.split("#[cfg(test)]")[0])
    found = set(re.findall(r"\bcrate::([a-z_]+)", code))
    for group in re.findall(r"\bcrate::\{([^;]*)\};", code):
        found |= set(re.findall(r"(?:^|,)\s*([a-z_]+)", re.sub(r"\{[^{}]*\}", "", group)))
    return found


def test_rust_imports_run_one_way(root):
    wrong = []
    for room, path in rust_rooms(root):
        if room not in RUST_ORDER:
            continue
        above = set(RUST_ORDER[RUST_ORDER.index(room) + 1 :])
        wrong += [f"{path.relative_to(root)} uses crate::{name}" for name in rust_uses(path.read_text()) & above]
    assert wrong == []


@pytest.mark.parametrize("room", BLIND)
def test_rust_rooms_that_know_no_kinematics(root, room):
    files = [path for name, path in rust_rooms(root) if name == room]
    assert files, f"there is no room {room} any more: mend this test"
    knowing = set(RUST_ORDER) | {"inverse", "identifiability"}
    wrong = [f"{path.relative_to(root)}: {name}" for path in files for name in rust_uses(path.read_text()) & knowing]
    assert wrong == []


def test_core_is_pure_rust(root):
    manifest = (root / "crates" / "ulna" / "Cargo.toml").read_text()
    assert "pyo3" not in manifest
    assert "numpy" not in manifest


def test_importing_ulna_loads_nothing_heavy(root):
    code = "import sys, ulna; print([name for name in ('numpy', 'polars', 'scipy', 'rich') if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=root)
    assert done.stdout.strip() == "[]"
