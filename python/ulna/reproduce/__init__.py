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
    "shimojima2002": (
        "Shimojima, Furutani, Takamasu 2002: a ball plate; 23 parameters, 21 of them calibrated",
        "ulna.reproduce.ways.shimojima2002",
    ),
    "santolaria2010": (
        "Santolaria, Aguilar 2010: a bar of 14 balls, many poses a ball, points and lengths together",
        "ulna.reproduce.ways.santolaria2010",
    ),
    "wang2007": (
        "Wang, Fei, Shang 2007: coordinates from a Cartesian measuring machine",
        "ulna.reproduce.ways.wang2007",
    ),
    "gao2009": (
        "Gao et al. 2009: one seat whose coordinates are known, or are not; simulated annealing",
        "ulna.reproduce.ways.gao2009",
    ),
    "wang2010": (
        "Wang X. et al. 2010: an evolutionary search on an arm of seven axes",
        "ulna.reproduce.ways.wang2010",
    ),
    "cheng2010": (
        "Cheng, Fei, Yu 2010: a probe from one seat",
        "ulna.reproduce.ways.cheng2010",
    ),
    "all": (
        "every way of the six above on the same two arms with the same noise: one table",
        "ulna.reproduce.ways.comparison",
    ),
}
