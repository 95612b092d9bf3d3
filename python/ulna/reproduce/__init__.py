"""Studies of the literature, rerun with this program: their numbers beside ours.

Each module has ``run(out, progress)``, which returns what was found; with a folder `out` it also writes pictures and
numbers there. `ulna reproduce NAME` prints it.
"""

#: name → (what it is in one line, module)
STUDIES: dict[str, tuple[str, str]] = {
    "cheng2011": (
        "Cheng, Yu, Fei 2011: a seven-axis arm from 101 lengths of a bar, then its straight probe from one seat",
        "ulna.reproduce.cheng2011",
    ),
}
