"""The built page: files of this package, and `index.html` for every screen."""

from __future__ import annotations

from pathlib import Path

from fastapi import FastAPI
from fastapi.responses import FileResponse, HTMLResponse, Response

from ulna.serve.problems import answer

FOLDER = Path(__file__).resolve().parent / "page"
MISSING = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Ulna</title>
<p>This Ulna was built without its page. In a checkout: <code>make page</code>, with Node 20.19 or newer. The API is
there all the same: <a href="/api/v1/openapi.json">/api/v1/openapi.json</a>.</p></html>"""
TYPES = {
    ".js": "text/javascript",
    ".css": "text/css",
    ".svg": "image/svg+xml",
    ".html": "text/html; charset=utf-8",
    ".txt": "text/plain; charset=utf-8",
}


def there() -> bool:
    """Whether it was built."""
    return (FOLDER / "index.html").is_file()


def install(app: FastAPI, folder: Path = FOLDER) -> None:
    """Last of all routes: what no other took."""

    @app.get("/{path:path}", include_in_schema=False)
    def page(path: str) -> Response:
        if path.startswith("api/"):
            return answer(404, f"/{path[:200]}: there is no such thing here.")
        if not (folder / "index.html").is_file():
            return HTMLResponse(MISSING, 503)
        found = _file(folder, path)
        if found is None and path.startswith("assets/"):
            return answer(404, f"/{path[:200]}: it is not here. Load the page anew.")
        found = found or folder / "index.html"
        return FileResponse(found, media_type=TYPES.get(found.suffix))


def _file(folder: Path, path: str) -> Path | None:
    """One of the built files by its path; None of all others."""
    known = {each.relative_to(folder).as_posix(): each for each in folder.rglob("*") if each.is_file()}
    return known.get(path)
