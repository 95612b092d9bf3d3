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
from typer.exceptions import TyperException

from ulna.cli.interrupting import ENDING, ended, prompt_interrupts, say_interrupted

BAD_INPUT = 2
FAULT = 3
"""What ends in this code is not the user's."""
TRACEBACK = "ULNA_TRACEBACK"
"""Set in the environment, a fault shows where it came from."""


Command = TypeVar("Command", bound=Callable[..., None])


def guard(command: Command) -> Command:
    """A command whose errors end in a message and an exit code, never in a traceback."""

    @functools.wraps(command)
    def guarded(*args: Any, **kwargs: Any) -> None:
        from ulna.ground.errors import InputWarning, UlnaInputError, cannot_be_read

        try:
            with prompt_interrupts(), warnings.catch_warnings():
                warnings.simplefilter("always", InputWarning)
                warnings.showwarning = _show_warning
                command(*args, **kwargs)
            sys.stdout.flush()
        except UlnaInputError as error:
            _fail(str(error))
        except KeyboardInterrupt:
            for number in ENDING:  # libraries may raise it twice; once is enough
                signal.signal(number, signal.SIG_IGN)
            say_interrupted()
            raise typer.Exit(ended()) from None
        except BrokenPipeError:
            # whoever read our output has seen enough; without this Python complains once more at exit
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        except OSError as error:
            _fail(cannot_be_read(error))
        except MemoryError:
            _fail("not enough memory for these readings. Use fewer rows at a time or a larger machine.")
        except (typer.Exit, typer.Abort, TyperException):  # wrong options: the command line's own words
            raise
        except Exception as error:
            said = _said(error, command)
            if said is not None:
                _fail(said)
            if os.environ.get(TRACEBACK):
                raise
            _fault(error)
        except BaseException as error:
            # a library in Rust that gives up, which Python takes for no Exception
            if type(error).__name__ != "PanicException" or os.environ.get(TRACEBACK):
                raise
            _fault(error)

    # typer would keep the line breaks of the source; paragraphs are all that is meant
    paragraphs = (inspect.getdoc(command) or "").split("\n\n")
    guarded.__doc__ = "\n\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)
    return guarded  # type: ignore[return-value]  # same signature, by functools.wraps


def _said(error: Exception, command: Command) -> str | None:
    """What an error of others means to the user; None of a fault of ours."""
    core = sys.modules.get("ulna._core")
    if core is not None and isinstance(error, core.UlnaError):
        return str(error)
    if isinstance(error, ModuleNotFoundError):
        from ulna.ground.extras import lacking

        said = lacking(error.name or "")
        return None if said is None else f"ulna {command.__name__.replace('_', '-')}: {said}"
    return None


def _fault(error: BaseException) -> None:
    from ulna.ground.errors import for_people
    from ulna.ground.faults import fault

    print(f"error: {for_people(fault(error))} {TRACEBACK}=1 shows how it came about.", file=sys.stderr)
    raise typer.Exit(FAULT) from None


def _fail(message: str) -> None:
    from ulna.ground.errors import for_people

    print(f"error: {for_people(message)}", file=sys.stderr)
    raise typer.Exit(BAD_INPUT) from None


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    from ulna.ground.errors import for_people

    print(f"warning: {for_people(str(message))}", file=sys.stderr)
