"""Comparing what the docs show with what is printed today."""

import math
import re
from itertools import zip_longest

NUMBER = re.compile(r"[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def same(shown: str, printed: str) -> list[str]:
    """Lines that differ, numbers in the last digits apart: other processors round otherwise."""
    differing = []
    for one, other in zip_longest(shown.splitlines(), printed.splitlines(), fillvalue=""):
        # a digit more or less moves columns, so runs of spaces and lines count as one
        words, others = (re.sub(r"[\s─]+", " ", NUMBER.sub("#", line)).strip() for line in (one, other))
        numbers = zip_longest(NUMBER.findall(one), NUMBER.findall(other), fillvalue="nan")
        close = all(
            math.isclose(float(a.replace("−", "-")), float(b.replace("−", "-")), rel_tol=0.02, abs_tol=2e-4)
            for a, b in numbers
        )
        if words != others or not close:
            differing.append(f"shown:   {one}\nprinted: {other}")
    return differing
