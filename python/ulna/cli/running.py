"""How every command runs: errors of the user as one message, warnings on stderr, exit codes, Ctrl-C."""

from __future__ import annotations

import functools
import inspect
import os
import signal
import sys
import warnings
from collections.abc import Callable
from typing import Any, TextIO, TypeVar

import typer

from ulna.cli.interrupting import INTERRUPTED, prompt_interrupts, say_interrupted

BAD_INPUT = 2

Command = TypeVar("Command", bound=Callable[..., None])


def guard(command: Command) -> Command:
    """A command whose errors end in a message and an exit code, never in a traceback."""

    @functools.wraps(command)
    def guarded(*args: Any, **kwargs: Any) -> None:
        from ulna.ground.errors import InputWarning, UlnaInputError

        try:
            with prompt_interrupts(), warnings.catch_warnings():
                warnings.simplefilter("always", InputWarning)
                warnings.showwarning = _show_warning
                command(*args, **kwargs)
            sys.stdout.flush()
        except UlnaInputError as error:
            _fail(str(error))
        except KeyboardInterrupt:
            signal.signal(signal.SIGINT, signal.SIG_IGN)  # libraries may raise it twice; once is enough
            say_interrupted()
            raise typer.Exit(INTERRUPTED) from None
        except BrokenPipeError:
            # whoever read our output has seen enough; without this Python complains once more at exit
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        except OSError as error:
            # a disk that is full, a network folder that went away: what nobody can foresee
            where = f"{error.filename}: " if error.filename else ""
            _fail(f"{where}cannot be read or written ({error.strerror or error}). Check the disk and the permissions.")
        except ValueError as error:
            if not _is_core_error(error):
                raise
            _fail(str(error))
        except ModuleNotFoundError as error:
            from ulna.ground.extras import lacking

            said = lacking(error.name or "")
            if said is None:
                raise
            _fail(f"ulna {command.__name__.replace('_', '-')}: {said}")
        except MemoryError:
            _fail("not enough memory for these readings. Use fewer rows at a time or a larger machine.")

    # typer would keep the line breaks of the source; paragraphs are all that is meant
    paragraphs = (inspect.getdoc(command) or "").split("\n\n")
    guarded.__doc__ = "\n\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)
    return guarded  # type: ignore[return-value]  # same signature, by functools.wraps


def _fail(message: str) -> None:
    print(f"error: {message}", file=sys.stderr)
    raise typer.Exit(BAD_INPUT) from None


def _is_core_error(error: ValueError) -> bool:
    core = sys.modules.get("ulna._core")
    return core is not None and isinstance(error, core.UlnaError)


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    print(f"warning: {message}", file=sys.stderr)
