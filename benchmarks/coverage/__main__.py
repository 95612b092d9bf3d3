"""``python -m benchmarks.coverage [simulated | real]``; without either, the page of the docs."""

import sys

from benchmarks.coverage import real, simulated, virtual

PARTS = {"simulated": simulated.main, "real": real.main}


def main() -> None:
    """Hand over to the part that is named."""
    given = sys.argv[1:]
    if given and given[0] in PARTS:
        PARTS[given[0]](given[1:])
    else:
        virtual.main(given)


if __name__ == "__main__":
    main()
