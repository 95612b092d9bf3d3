"""Pictures of a report of real readings, as a browser shows it: `python tools/docs_report_pictures.py`.

They need Chromium and the readings of kinematics_calibration beside the project, which are not part of it; so the
pictures are committed, and this is run by hand where the report's looks have changed.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

from docs_running import ROOT, ulna

DATA = ROOT.parent / "shared" / "data" / "mukca"
PICTURES = ROOT / "docs" / "pictures"
ROBOT = "panda_2_clean"
#: picture → width, height, what is shown of the page, dark
SHOWN: dict[str, tuple[int, int, str, bool]] = {
    "report-top.png": (1240, 830, "header, #summary, #quality", False),
    "report-joints.png": (1100, 1000, "#joints", False),
    "report-space.png": (1100, 760, "#space", True),
    "report-phone.png": (390, 780, "#summary, #distribution", False),
}
COLOURS = 256


def report(folder: Path) -> str:
    """The report of the second Panda, its places left out in turn. Raises RuntimeError."""
    steps = [
        ["import", "mukca", str(DATA / ROBOT), "-o", "panda"],
        ["calibrate", "panda/study.toml", "-o", "out"],
        ["cross-validate", "panda/study.toml", "--by", "placement", "-o", "left-out"],
        ["report", "out", "--cross-validation", "left-out/cross-validation.json", "-o", "report.html"],
    ]
    for arguments in steps:
        if arguments[0] == "calibrate":
            with (folder / "panda" / "study.toml").open("a", encoding="utf-8") as study:
                study.write('\n[fit]\nloss = "huber"\n')
        done = ulna(arguments, folder)
        if done.returncode != 0:
            raise RuntimeError(f"ulna {' '.join(arguments)} exited with {done.returncode}:\n{done.stderr}")
    return (folder / "report.html").read_text(encoding="utf-8")


def picture(browser: str, page: str, name: str, folder: Path) -> None:
    """Some sections of the page as a PNG of few colours."""
    width, height, sections, dark = SHOWN[name]
    kept = f"header, nav, section {{ display: none }} {sections} {{ display: block }} h2 {{ margin-top: 12px }}"
    changed = page.replace("</style>", f"{kept}</style>", 1)
    theme = "dark" if dark else "light"
    changed = changed.replace("<html ", f'<html data-theme="{theme}" ', 1)
    (folder / "shown.html").write_text(changed, encoding="utf-8")
    command = [browser, "--headless", "--no-sandbox", "--hide-scrollbars", "--enable-unsafe-swiftshader"]
    command += ["--virtual-time-budget=60000", f"--window-size={width},{height}", "--screenshot=shown.png"]
    subprocess.run([*command, (folder / "shown.html").as_uri()], cwd=folder, check=True, capture_output=True)
    shot = Image.open(folder / "shown.png").convert("RGB")
    shot.quantize(COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(PICTURES / name, optimize=True)


def main() -> None:
    browser = next((found for each in ("chromium", "google-chrome") if (found := shutil.which(each))), None)
    if browser is None or not DATA.is_dir():
        sys.exit(f"needs Chromium and {DATA}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        page = report(folder)
        for each in SHOWN:
            picture(browser, page, each, folder)
            print(PICTURES / each)


if __name__ == "__main__":
    main()
