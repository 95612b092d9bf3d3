"""What the tab key completes: names of ours here, commands and options by Typer, files by the shell itself.

A function is called while somebody waits for a key, so each imports a table of names and nothing that computes.
"""

from __future__ import annotations

import os

VARIABLE = "_ULNA_COMPLETE"
"""Set by a shell that asks for completions."""
SHELLS = ("bash", "zsh", "fish", "powershell", "pwsh")


def get_ready() -> None:
    """Where a shell asks for completions: make Typer know the shells."""
    if VARIABLE in os.environ:
        from typer.completion import completion_init  # type: ignore[attr-defined]  # handed on, unsaid

        completion_init()


def shells(incomplete: str) -> list[str]:
    return [name for name in SHELLS if name.startswith(incomplete)]


def studies(incomplete: str) -> list[str]:
    """Works that can be rerun."""
    from ulna.reproduce import STUDIES

    return [name for name in STUDIES if name.startswith(incomplete)]


def languages(incomplete: str) -> list[str]:
    from ulna.documents.languages.languages import LANGUAGES

    return [code for code in LANGUAGES if code.startswith(incomplete)]


def demos(incomplete: str) -> list[str]:
    """Examples that come with Ulna."""
    from ulna.cli.demos import DEMOS

    return [name for name in DEMOS if name.startswith(incomplete)]
