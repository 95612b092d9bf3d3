"""Pages as a browser shows them, and scripts as an engine of JavaScript runs them; tests skip where there is none."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

from tests.real_parts import lacking


def dom(page: str, folder: Path, script: str = "") -> str:
    """The page's document after its scripts, and then `script`, have run in Chromium. Its own policy would not let
    that run, so a page with a script has none."""
    browser = next((found for each in ("chromium", "google-chrome") if (found := shutil.which(each))), None)
    if browser is None:
        lacking("Chromium")
    if script:
        page = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", page)
        page = page.replace("</body>", f"<script>{script}</script></body>")
    (folder / "page.html").write_text(page, encoding="utf-8")
    command = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1200,900"]
    command += [f"--user-data-dir={folder / 'profile'}", "--virtual-time-budget=3000", "--dump-dom"]
    done = subprocess.run([*command, (folder / "page.html").as_uri()], capture_output=True, timeout=120, check=True)
    return done.stdout.decode()


def node(script: str, folder: Path) -> str:
    """What a script prints under Node.js."""
    program = shutil.which("node")
    if program is None:
        lacking("Node.js")
    (folder / "script.js").write_text(script, encoding="utf-8")
    done = subprocess.run([program, "script.js"], cwd=folder, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout
