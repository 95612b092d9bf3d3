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
    "control": 2,
    "formats": 2,
    "geometry": 2,
    "arm": 3,
    "artefacts": 4,
    "exchange": 4,
    "pictures": 4,
    "study": 5,
    "measuring": 6,
    "simulation": 6,
    "calibration": 6,
    "proposals": 6,
    "comparison": 7,
    "verification": 7,
    "planning": 7,
    "reproduce": 7,
    "uncertainties": 8,
    "checking": 8,
    "documents": 9,
    "live": 10,
    "records": 10,
    "serve": 11,
    "cli": 12,
    "__main__": 13,
}

#: rooms of the Rust core, from the ground up: each uses only what stands on floors below its own
RUST_FLOORS = [
    {"error", "monitor", "seeds", "simd", "geometry"},
    {"arm", "solver", "design"},
    {"kinematics"},
    {"artefacts"},
    {"problem"},
    {"identify"},
    {"fit"},
]
#: what a file of the core defines: a door (mod.rs, lib.rs) has none of these, it only names and hands on
RUST_ITEM = re.compile(r"^(?:pub(?:\([^)]*\))? )?(?:fn|struct|enum|trait|impl|const|static|type)\b", re.MULTILINE)


def modules(root: Path) -> dict[str, Path]:
    """Dotted name → file, of all of python/ulna."""
    package = root / "python" / "ulna"
    found = {}
    for path in package.rglob("*.py"):
        parts = ("ulna", *path.relative_to(package).with_suffix("").parts)
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported(tree: ast.AST, known: Iterable[str]) -> list[tuple[str, int]]:
    """(module, line) of every import of ulna: at the top, inside a function, for type checking only, or by a text that
    names a module."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == "ulna":
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                found.append((full if full in known else node.module, node.lineno))
        elif isinstance(node, ast.Import):
            found += [(alias.name, node.lineno) for alias in node.names if alias.name.split(".")[0] == "ulna"]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and "." in node.value:
            found += [(node.value, node.lineno)] if node.value in known else []
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
        "if TYPE_CHECKING:\n    from ulna.study.study import Study\nLATER = {'f': 'ulna.cli.f'}\nNONE = 'ulna.cli.g'\n"
    )
    known = ["ulna.cli", "ulna.cli.f", "ulna.cli.output", "ulna.documents.write", "ulna.study.study"]
    assert sorted(imported(ast.parse(source), known), key=lambda found: found[1]) == [
        ("ulna.cli.output", 1),
        ("ulna.documents.write", 3),
        ("ulna.study.study", 5),
        ("ulna.cli.f", 6),
    ]
    assert circle_in({"a": ["b"], "b": ["c"], "c": ["a"]}) == ["a", "b", "c", "a"]
    assert circle_in({"a": ["b", "c"], "b": ["c"]}) == []


Module = tuple[str, ...]


def rust_files(root: Path) -> dict[Module, Path]:
    """Every file of the core by its module: ``("solver", "gram")``."""
    source = root / "crates" / "ulna" / "src"
    found = {}
    for path in source.rglob("*.rs"):
        parts = path.relative_to(source).with_suffix("").parts
        found[parts[:-1] if parts[-1] in ("mod", "lib") else parts] = path
    return found


def rust_code(path: Path) -> str:
    """What a file says to the compiler, its tests and comments left out."""
    return re.sub(r"//[^\n]*", "", re.split(r"#\[cfg\(test\)\]\n(?:pub\(crate\) )?mod ", path.read_text())[0])


def rust_paths(tree: str) -> list[str]:
    """The paths of a `use` tree: ``a::{b, c::{d}}`` is a::b and a::c::d."""
    group = re.fullmatch(r"(?:([\w:]*?)::)?\{(.*)\}", tree.strip(), re.DOTALL)
    if group is None:
        return [tree.split(" as ")[0].strip()] if tree.strip() else []
    parts, depth = [""], 0
    for letter in group[2]:
        depth += (letter == "{") - (letter == "}")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [f"{group[1]}::{path}" if group[1] else path for part in parts for path in rust_paths(part)]


def rust_uses(codes: dict[Module, str]) -> dict[Module, set[Module]]:
    """Which files each file uses; what a door hands on is used where it is defined."""
    handed: dict[Module, dict[str, list[str]]] = {}
    for module, code in codes.items():
        for tree in re.findall(r"\bpub(?:\([^)]*\))? use ([^;]+);", code):
            handed.setdefault(module, {}).update({p.split("::")[-1]: p.split("::") for p in rust_paths(tree)})

    def resolved(module: Module, path: list[str]) -> Module | None:
        at, rest = module, path
        if path[0] == "crate":
            at, rest = (), path[1:]
        elif path[0] != "super" and (*module, path[0]) not in codes:
            return None
        while rest and rest[0] == "super":
            at, rest = at[:-1], rest[1:]
        while rest and (*at, rest[0]) in codes:
            at, rest = (*at, rest[0]), rest[1:]
        passed_on = handed.get(at, {}).get(rest[0]) if rest else None
        return at if passed_on is None else resolved(at, passed_on)

    uses: dict[Module, set[Module]] = {}
    for module, code in codes.items():
        trees = re.findall(r"\buse ([^;]+);", code)
        inline = re.findall(r"\b((?:crate|super)(?:::\w+)+)", re.sub(r"\buse [^;]+;|pub\(in [^)]*\)", "", code))
        paths = [path.split("::") for tree in trees for path in rust_paths(tree)] + [i.split("::") for i in inline]
        uses[module] = {there for path in paths if (there := resolved(module, path)) not in (None, module)}
    return uses


def circle(edges: dict[Module, set[Module]]) -> list[Module]:
    """One circle among the edges, if there is any."""
    done: set[Module] = set()

    def visit(node: Module, trail: list[Module]) -> list[Module]:
        if node in trail:
            return [*trail[trail.index(node) :], node]
        found: list[Module] = []
        if node not in done:
            found = next((c for to in sorted(edges.get(node, ())) if (c := visit(to, [*trail, node]))), [])
            done.add(node)
        return found

    return next((found for node in sorted(edges) if (found := visit(node, []))), [])


@pytest.fixture
def rust(root):
    files = rust_files(root)
    codes = {module: rust_code(path) for module, path in files.items()}
    doors = {module for module, path in files.items() if path.name in ("mod.rs", "lib.rs")}
    uses = {module: there for module, there in rust_uses(codes).items() if module not in doors}
    return codes, doors, uses


def test_every_rust_room_is_on_one_floor(rust):
    codes, _, _ = rust
    rooms = [room for floor in RUST_FLOORS for room in sorted(floor)]
    assert sorted({module[0] for module in codes if module}) == sorted(rooms), "give each room its floor"


def test_rust_imports_run_one_way(rust):
    _, _, uses = rust
    floor = {room: number for number, rooms in enumerate(RUST_FLOORS) for room in rooms}
    arrows = {(module, to) for module, there in uses.items() for to in there if module[0] != to[0]}
    assert len(arrows) > 100, "the check sees hardly any import"
    wrong = sorted(f"{'::'.join(a)} uses {'::'.join(b)}" for a, b in arrows if floor[a[0]] <= floor[b[0]])
    assert wrong == []


def test_rust_doors_are_thin(rust):
    codes, doors, uses = rust
    thick = {"::".join(module): RUST_ITEM.findall(codes[module]) for module in doors}
    assert {module: items for module, items in thick.items() if items} == {}
    assert {"::".join(module): there & doors for module, there in uses.items() if there & doors} == {}


def test_rust_files_and_folders_form_no_circle(rust):
    codes, _, uses = rust
    assert circle(uses) == []
    for folder in sorted({module[:depth] for module in codes for depth in range(len(module))}):
        inside: dict[Module, set[Module]] = {}
        depth = len(folder)
        for module, there in uses.items():
            if module[:depth] == folder != module:
                others = {to[: depth + 1] for to in there if to[:depth] == folder != to}
                inside.setdefault(module[: depth + 1], set()).update(others - {module[: depth + 1]})
        assert circle(inside) == [], f"among the parts of {'::'.join(folder) or 'the core'}"


def test_the_rust_check_sees_a_circle_and_what_a_door_hands_on():
    codes = {
        ("a",): "mod b;\npub use b::{Thing, Other};",
        ("a", "b"): "use super::c::{helper, deep::{One, Two}};",
        ("a", "c"): "use crate::a::Thing;",
        ("d",): "fn f() { crate::a::Other::new() }",
    }
    uses = rust_uses(codes)
    assert uses[("a", "b")] == {("a", "c")}
    assert uses[("a", "c")] == {("a", "b")}
    assert uses[("d",)] == {("a", "b")}
    assert circle(uses) != []


def test_core_is_pure_rust(root):
    manifest = (root / "crates" / "ulna" / "Cargo.toml").read_text()
    assert "pyo3" not in manifest
    assert "numpy" not in manifest


def test_importing_ulna_loads_nothing_heavy(root):
    code = "import sys, ulna; print([name for name in ('numpy', 'polars', 'scipy', 'rich') if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=root)
    assert done.stdout.strip() == "[]"
