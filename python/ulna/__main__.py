"""`python -m ulna` and the command `ulna`: from here on Ctrl-C is answered in one line."""

from __future__ import annotations

import gc
import os
import signal
import sys
from typing import Any


def main() -> None:
    """The console script. While the program is still being imported there is nothing to take away."""
    before = signal.getsignal(signal.SIGINT)
    if before is signal.default_int_handler:  # not where the shell said to ignore it
        signal.signal(signal.SIGINT, _leave)
    gc.set_threshold(100_000)  # loading makes objects that stay: looking for garbage among them is in vain
    # looking for plug-ins that nobody has for us takes longer than reading a study
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    from ulna.cli import main as run

    signal.signal(signal.SIGINT, before)
    run()


def _leave(_signal: int, _frame: Any) -> None:
    # an exception could be caught by whatever is being imported, or end in its traceback
    os.write(sys.__stderr__.fileno() if sys.__stderr__ else 2, b"\nInterrupted. Nothing was written.\n")
    os._exit(130)


if __name__ == "__main__":
    main()
