"""`python -m ulna`: the same as the command `ulna`."""

from ulna.cli import main

main()
