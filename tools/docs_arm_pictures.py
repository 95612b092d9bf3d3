"""Pictures of arms that the docs show, as SVG: `python tools/docs_arm_pictures.py`. The page of `ulna show` as a
browser shows it, `show.png`, is made too where Chromium is at hand.

A test compares the SVGs with what is drawn today. They follow the reader's light or dark.
"""

import math
import shutil
import subprocess

import numpy as np
from PIL import Image

from docs_running import ROOT, reader_folder, ulna
from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.pictures.scene import scene
from ulna.pictures.svg import picture, standalone
from ulna.pictures.view import AZIMUTH_RAD, ELEVATION_RAD, fitted

PICTURES = ROOT / "docs" / "pictures"
#: a link of which nothing is zero, then a joint that carries a probe
LINK = Arm(
    "one link",
    (Joint(math.radians(48.0), math.radians(-55.0), 230.0, 150.0), Joint()),
    {"tip": Probe(0.0, 0.0, 90.0, 12.0)},
)
LINK_POSE_DEG = (0.0, 0.0)
#: of the arm that comes with Ulna
PLATINUM_POSE_DEG = (60.0, 75.0, 20.0, 120.0, 20.0, 90.0, 0.0)
SHOW = ["show", "examples/platinum/truth.toml", "--pose", ",".join(f"{each:g}" for each in PLATINUM_POSE_DEG)]
SIZE = (1240, 800)
COLOURS = 256


def arm_pictures() -> dict[str, str]:
    """File name → SVG."""
    drawn = scene(LINK, thickness=0.018)
    q_rad = np.radians(LINK_POSE_DEG)
    view = fitted(drawn, q_rad, 680.0, 460.0, math.radians(-70.0), math.radians(34.0))
    title = "Two joints and the link between them, with theta0, d, a and alpha"
    link = picture(drawn, q_rad, view, title, ("axes", "frames"), lit=(1,))
    platinum = scene(Arm.load(ROOT / "examples" / "platinum" / "truth.toml"))
    q_rad = np.radians(PLATINUM_POSE_DEG)
    view = fitted(platinum, q_rad, 760.0, 520.0, AZIMUTH_RAD, ELEVATION_RAD)
    title = "A measuring arm of seven joints with its axes and frames"
    whole = picture(platinum, q_rad, view, title, ("axes", "frames", "floor"))
    return {"dh-link.svg": standalone(link), "arm.svg": standalone(whole)}


def page_picture(browser: str) -> None:
    """The page of `ulna show` in light colours, as a PNG of few. Raises RuntimeError."""
    with reader_folder() as folder:
        done = ulna([*SHOW, "-o", "show.html"], folder)
        if done.returncode != 0:
            raise RuntimeError(f"ulna {' '.join(SHOW)} exited with {done.returncode}:\n{done.stderr}")
        width, height = SIZE
        command = [browser, "--headless", "--no-sandbox", "--hide-scrollbars", f"--window-size={width},{height}"]
        command += ["--virtual-time-budget=5000", "--screenshot=shown.png", (folder / "show.html").as_uri()]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        shot = Image.open(folder / "shown.png").convert("RGB")
        few = shot.quantize(COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
        few.save(PICTURES / "show.png", optimize=True)


def main() -> None:
    for name, text in arm_pictures().items():
        (PICTURES / name).write_text(text, encoding="utf-8")
        print(PICTURES / name)
    browser = next((found for each in ("chromium", "google-chrome") if (found := shutil.which(each))), None)
    if browser is None:
        print("show.png: no Chromium, left as it was")
    else:
        page_picture(browser)
        print(PICTURES / "show.png")


if __name__ == "__main__":
    main()
