"""The house in order: file sizes, nothing of this or that machine in committed files, docs that name what there is."""

import json
import re
import subprocess
from pathlib import Path

import pytest

#: asked of every file above this: do two things live there?
MOST_LINES = 400
#: written in pieces, so that this file does not name them
HOSTS = [
    "pypi" + ".org",
    "pythonhosted" + ".org",
    "static.crates" + ".io",
    "index.crates" + ".io",
    "registry.npmjs" + ".org",
    "proxy.golang" + ".org",
    "repo1.maven" + ".org",
    "deb.debian" + ".org",
]
MACHINE_PATHS = [r"/work/(main|shared|\.library)", r"/root/", r"/home/[a-z]+/", r"/tmp/ulna"]


def committed(root: Path) -> list[Path]:
    """Files under version control; the files of a plain copy without git cannot be told apart from built ones."""
    done = subprocess.run(["git", "ls-files", "-z"], cwd=root, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        pytest.skip("not a git checkout")
    return [root / name for name in done.stdout.split("\0") if name and (root / name).is_file()]


def texts(root: Path) -> list[tuple[Path, str]]:
    out = []
    for path in committed(root):
        if path.suffix in {".png", ".parquet", ".ico", ".zip", ".journal"}:
            continue
        out.append((path.relative_to(root), path.read_text(encoding="utf-8")))
    return out


def test_no_file_outgrows_its_job(root):
    sources = [(path, text) for path, text in texts(root) if path.suffix in {".py", ".rs", ".pyi", ".cpp", ".sh"}]
    assert len(sources) > 50
    long = {str(path): text.count("\n") for path, text in sources if text.count("\n") > MOST_LINES}
    assert long == {}


def test_no_registry_host_in_committed_files(root):
    found = [f"{path}: {host}" for path, text in texts(root) for host in HOSTS if host in text]
    assert found == []


def test_no_machine_path_in_committed_files(root):
    this = Path(__file__).resolve().relative_to(root)
    found = []
    for path, text in texts(root):
        if path == this:
            continue
        found += [f"{path}: {match.group()}" for match in re.finditer("|".join(MACHINE_PATHS), text)]
    assert found == []


def test_no_room_called_utils(root):
    assert [str(path) for path, _ in texts(root) if re.search(r"(^|/)(utils?|helpers?|misc)(\.|/)", str(path))] == []


def docs(root: Path) -> str:
    return "\n".join(path.read_text(encoding="utf-8") for path in sorted((root / "docs").rglob("*.md")))


def test_docs_name_every_command_and_option(root):
    import typer.main

    from ulna.cli import app

    page = (root / "docs" / "reference" / "commands.md").read_text(encoding="utf-8")
    missing = []

    def look(command: object, words: str) -> None:
        if f"`{words}" not in page and f"## {words}" not in page:
            missing.append(words)
        for parameter in getattr(command, "params", []):
            options = [name for name in parameter.opts if name.startswith("--")]
            missing.extend(f"{words} {name}" for name in options if name not in ("--help",) and f"`{name}" not in page)
        for name, inner in getattr(command, "commands", {}).items():
            look(inner, f"{words} {name}")

    look(typer.main.get_command(app), "ulna")
    assert missing == []


def keys_of(schema: object) -> set[str]:
    """Names of all properties anywhere in a JSON schema."""
    if isinstance(schema, dict):
        own = set(schema["properties"]) if isinstance(schema.get("properties"), dict) else set()
        return own.union(*(keys_of(value) for value in schema.values())) if schema else own
    if isinstance(schema, list):
        return set().union(*(keys_of(value) for value in schema))
    return set()


def test_docs_name_every_key_of_every_format(root):
    page = (root / "docs" / "reference" / "files.md").read_text(encoding="utf-8")
    schemas = sorted((root / "schemas").glob("*.json"))
    assert schemas, "the schemas are committed under schemas/"
    missing = []
    for path in schemas:
        keys = keys_of(json.loads(path.read_text(encoding="utf-8")))
        missing += [f"{path.name}: {key}" for key in sorted(keys) if not re.search(rf"\b{re.escape(key)}\b", page)]
    assert missing == []


def test_contributing_has_a_line_for_every_folder(root):
    text = (root / "CONTRIBUTING.md").read_text(encoding="utf-8")
    folders = {path.relative_to(root).parts[0] for path in committed(root) if len(path.relative_to(root).parts) > 1}
    assert [folder for folder in sorted(folders) if f"`{folder}/" not in text] == []


def test_pictures_in_docs_exist_and_are_used(root):
    text = docs(root)
    used = {Path(name).name for name in re.findall(r"\]\(([^)]+\.(?:png|svg))\)", text)}
    there = {path.name for path in (root / "docs").rglob("*") if path.suffix in {".png", ".svg"}} - {"logo.svg"}
    assert used == there
