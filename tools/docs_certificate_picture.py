"""Pictures of the printed certificate, drawn by Typst as it sets the PDF: `python tools/docs_certificate_picture.py`.

They show no more than the looks, and the pages are linked to as PDF, so this is run by hand where the looks have
changed.
"""

import io

from PIL import Image

from docs_reports import STEPS
from docs_running import ROOT, reader_folder, ulna
from ulna.documents.gather import gather
from ulna.documents.pdf.render import certificate
from ulna.documents.pdf.typeset import pictures

#: picture → pages, from 1, side by side
SHOWN = {"certificate-first.png": (1,), "certificate-results.png": (2, 3)}
PPI = 92.0
COLOURS = 32


def pages() -> list[Image.Image]:
    """The pages of the certificate that the documentation links to. Raises RuntimeError."""
    with reader_folder() as folder:
        for arguments in STEPS:
            done = ulna(arguments, folder)
            if done.returncode != 0:
                raise RuntimeError(f"ulna {' '.join(arguments)} exited with {done.returncode}:\n{done.stderr}")
        content = gather(
            folder / "out" / "demo",
            study=folder / "examples" / "platinum" / "study.toml",
            evaluation=folder / "out" / "check" / "evaluation.json",
            laboratory=folder / "examples" / "platinum" / "laboratory.toml",
            verified=folder / "out" / "test" / "verification.json",
        )
        data, fonts = certificate(content, "en")
        return [Image.open(io.BytesIO(page)).convert("RGB") for page in pictures(data, fonts, PPI)]


def main() -> None:
    found = pages()
    for name, numbers in SHOWN.items():
        shown = [found[number - 1] for number in numbers]
        gap = 12
        picture = Image.new("RGB", (sum(p.width + gap for p in shown) + gap, shown[0].height + 2 * gap), "#c8ccd0")
        left = gap
        for page in shown:
            picture.paste(page, (left, gap))
            left += page.width + gap
        few = picture.quantize(COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
        few.save(ROOT / "docs" / "pictures" / name, optimize=True)


if __name__ == "__main__":
    main()
