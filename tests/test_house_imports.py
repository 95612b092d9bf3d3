"""Imports run one way, in Python and in Rust, so that every room can be understood without the rooms above it."""

import ast
import re
from pathlib import Path

import pytest

#: from the bottom up; a module may import from its own line and from the lines below it
PYTHON_LAYERS = [
    {"_core"},
    {"errors", "cores"},
    {"geometry"},
    {"effects"},
    {"directions"},
    {"model"},
    {"frames"},
    {"study"},
    {"parameters", "options", "simulation", "plan_spec", "performance"},
    {"files"},
    {
        "assembly",
        "running",
        "estimators",
        "surfaces",
        "figures",
        "residuals",
        "outliers",
        "extras",
        "provenance",
        "probes",
        "folds",
        "tip_uncertainty",
        "measuring",
        "result",
        "calibrate",
        "identify",
        "evaluate",
        "measure",
        "cross_validate",
        "urdf",
        "importers",
        "export",
        "virtual",
        "simulate",
        "work",
        "batch",
        "uncertainty",
        "planning",
        "verification",
        "reproduce",
    },
    {"report"},
    {"certificate", "document"},
    {"cli", "__main__"},
]
LAYER = {name: number for number, names in enumerate(PYTHON_LAYERS) for name in names}

#: doors that stand below the files for the user's sake: Arm.load, Arm.save, Study.load; they import inside the function
DOORS = {("model", "files"), ("study", "files")}

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


def python_modules(root: Path) -> list[Path]:
    package = root / "python" / "ulna"
    return sorted(path for path in package.rglob("*.py") if path.name != "__init__.py" or path.parent != package)


def room_of(path: Path, root: Path) -> str:
    return path.relative_to(root / "python" / "ulna").with_suffix("").parts[0]


def rooms_imported(tree: ast.Module) -> list[tuple[str, int, bool]]:
    """(room, line, inside a function or for type checking only) of every import of ulna."""
    found = []
    for node, deferred in _walk(tree, deferred=False):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == "ulna":
            parts = node.module.split(".")
            rooms = [parts[1]] if len(parts) > 1 else [alias.name for alias in node.names]
            found += [(room, node.lineno, deferred) for room in rooms]
        elif isinstance(node, ast.Import):
            names = [alias.name.split(".") for alias in node.names]
            found += [(name[1], node.lineno, deferred) for name in names if name[0] == "ulna" and len(name) > 1]
    return found


def _walk(node: ast.AST, deferred: bool) -> list[tuple[ast.AST, bool]]:
    out = []
    for child in ast.iter_child_nodes(node):
        typing_only = isinstance(child, ast.If) and "TYPE_CHECKING" in ast.dump(child.test)
        later = deferred or typing_only or isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef)
        out.append((child, deferred))
        out += _walk(child, later)
    return out


def test_every_python_room_has_a_layer(root):
    rooms = {room_of(path, root) for path in python_modules(root)}
    assert rooms <= set(LAYER), "give each new room its place in PYTHON_LAYERS"


def test_python_imports_run_one_way(root):
    wrong = []
    for path in python_modules(root):
        room = room_of(path, root)
        for imported, line, deferred in rooms_imported(ast.parse(path.read_text(encoding="utf-8"))):
            if imported not in LAYER or imported == room:
                continue  # `ulna` itself offers public names; a room's own files are its own business
            upward = LAYER[imported] > LAYER[room]
            if upward and not (deferred and (room, imported) in DOORS):
                wrong.append(f"{path.relative_to(root)}:{line} imports {imported} from above")
    assert wrong == []


def test_the_import_check_sees_a_wrong_import():
    source = "from ulna.cli import output\ndef f():\n    import ulna.report.tables\n"
    assert rooms_imported(ast.parse(source)) == [("cli", 1, False), ("report", 3, True)]


def test_python_rooms_of_one_layer_form_no_circle(root):
    edges: dict[str, set[str]] = {}
    for path in python_modules(root):
        room = room_of(path, root)
        for imported, _, deferred in rooms_imported(ast.parse(path.read_text(encoding="utf-8"))):
            if imported in LAYER and imported != room and not deferred:
                edges.setdefault(room, set()).add(imported)
    done: set[str] = set()

    def visit(room: str, trail: tuple[str, ...]) -> None:
        assert room not in trail, f"circular imports: {' → '.join((*trail, room))}"
        if room not in done:
            for imported in sorted(edges.get(room, ())):
                visit(imported, (*trail, room))
            done.add(room)

    for room in sorted(edges):
        visit(room, ())


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
    import subprocess
    import sys

    code = "import sys, ulna; print([name for name in ('numpy', 'polars', 'scipy', 'rich') if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=root)
    assert done.stdout.strip() == "[]"
