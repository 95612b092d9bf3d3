"""The reports and pages that the documentation links to, made while it is built by a hook of MkDocs; not committed."""

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))

from docs_running import reader_folder, ulna

#: the experiment of Cheng, Yu and Fei (2011) on the virtual arm of their Table 4: 101 bars fitted, fresh bars held out,
#: and an acceptance test, measured by the true arm and evaluated with the calibrated one
PLAN = [
    "verify",
    "--make-plan",
    "iso-10360-12",
    "examples/platinum/platinum.toml",
    "--play",
    "examples/platinum/truth.toml",
    "-o",
    "test",
]
STEPS = [
    ["calibrate", "examples/platinum/study.toml", "-o", "out/demo"],
    ["evaluate", "out/demo/result.json", "examples/platinum/check.toml", "-o", "out/check"],
    PLAN,
    ["verify", "out/demo/result.json", "test/plan.toml", "-o", "out/test"],
]
REPORT = ["report", "out/demo", "--evaluation", "out/check/evaluation.json"]
REPORT += ["--verification", "out/test/verification.json", "--lab", "examples/platinum/laboratory.toml"]
LANGUAGES = ("en", "de")
#: the page of an arm that the page on `ulna show` links to
SHOW = ["show", "examples/platinum/truth.toml", "--pose", "60,75,20,120,20,90,0", "-o"]


def cheng2011_reports() -> dict[str, bytes]:
    """Name → page (HTML and PDF), for each language that the example's laboratory file knows. Raises RuntimeError."""
    with reader_folder() as folder:
        names = {language: f"cheng2011-{language}.html" for language in LANGUAGES}
        written = [[*REPORT, "--language", each, "-o", name] for each, name in names.items()]
        papers = [f"cheng2011-{language}.pdf" for language in LANGUAGES]
        written += [[*REPORT, "--pdf", "--language", each, "-o", papers[k]] for k, each in enumerate(LANGUAGES)]
        for arguments in [*STEPS, *written]:
            done = ulna(arguments, folder)
            if done.returncode != 0:
                raise RuntimeError(f"ulna {' '.join(arguments)} exited with {done.returncode}:\n{done.stderr}")
        return {name: (folder / name).read_bytes() for name in (*names.values(), *papers)}


def arm_pages() -> dict[str, bytes]:
    """Name → page of `ulna show`, in each language. Raises RuntimeError."""
    found = {}
    with reader_folder() as folder:
        for language in LANGUAGES:
            name = f"platinum-{language}.html"
            done = ulna([*SHOW, name, "--language", language], folder)
            if done.returncode != 0:
                raise RuntimeError(f"ulna {' '.join(SHOW)} exited with {done.returncode}:\n{done.stderr}")
            found[name] = (folder / name).read_bytes()
    return found


def on_files(files: Any, config: Any) -> Any:
    """Called by MkDocs: the reports stand in the site's folder reports/."""
    from mkdocs.structure.files import File

    for name, content in (cheng2011_reports() | arm_pages()).items():
        files.append(File.generated(config, f"reports/{name}", content=content))
    return files
