"""The only door to the terminal: a line is one line, and contains nothing that commands a terminal.

Names of frames, topics and nodes, texts of logs and of errors come from others. What they contain
must not forge a line, hide one, turn its direction or change the terminal.
"""

from __future__ import annotations

import contextlib
import logging
import os
import sys
from typing import TextIO

from webviz.data.names import escaped, readable

OUTPUT, ERRORS = 1, 2
"""File descriptors."""
STREAMS = ("stdin", "stdout", "stderr")
"""Names of the streams in the order of their file descriptors."""


def claim_output() -> None:
    """Reserve standard output for Python; what libraries in C++ print there becomes an error text.

    Fast DDS writes its complaints to the file descriptor, in the middle of JSON. A standard stream
    that is closed, as by `>&-`, leads nowhere from now on, and no file takes its place.
    """
    for number, name in enumerate(STREAMS):
        if getattr(sys, name) is None:
            nowhere = os.open(os.devnull, os.O_RDWR)
            if nowhere != number:
                os.dup2(nowhere, number)
                os.close(nowhere)
            setattr(sys, name, open(number, "r" if number == 0 else "w"))  # noqa: SIM115 - until the program ends
    stdout = sys.stdout
    with contextlib.suppress(OSError, AttributeError):  # replaced: there is nothing to keep
        if stdout.fileno() != OUTPUT:
            return
        stdout.flush()
        own = os.dup(OUTPUT)
        os.dup2(ERRORS, OUTPUT)
        sys.stdout = open(  # noqa: SIM115 - until the program ends
            own,
            "w",
            encoding=stdout.encoding,
            errors=stdout.errors,
            buffering=1 if stdout.isatty() else -1,
        )


def say(*lines: str) -> None:
    """Write lines to standard output, each as one line of readable text."""
    _write(sys.stdout, lines)


def warn(*lines: str) -> None:
    """Write lines to standard error, each as one line of readable text."""
    _write(sys.stderr, lines)


def say_painted(text: str) -> None:
    """Write lines with colours of the terminal, whose other parts are `readable` already."""
    print(text, flush=True)


def say_json(text: str) -> None:
    """Write JSON; what its texts contain that is not readable is escaped."""
    print(escaped(text), end="", flush=True)


def show(text: str, end: str = "") -> None:
    """Show a line on standard error, if that is a terminal, until the next one is written.

    Args:
        text: the line.
        end: "\\r" if the next one does not begin with it.
    """
    if sys.stderr.isatty():
        print(f"\r{readable(text)}\x1b[K{end}", end="", file=sys.stderr, flush=True)


class LogFormatter(logging.Formatter):
    """Writes each message of a log as one line, and the lines of tracebacks below it."""

    def __init__(self) -> None:
        super().__init__("%(name)s: %(message)s")

    def formatMessage(self, record: logging.LogRecord) -> str:
        """Return a message as one line."""
        return readable(super().formatMessage(record))

    def format(self, record: logging.LogRecord) -> str:
        """Return a message, and below it a traceback, whose last line may be a text of others."""
        return "\n".join(map(readable, super().format(record).split("\n")))


def _write(stream: TextIO, lines: tuple[str, ...]) -> None:
    print(*map(readable, lines), sep="\n", file=stream, flush=True)


def progress(what: str, share: float) -> None:
    """Show what is done and the share of it; the next line that is written replaces it."""
    bar = "█" * round(20 * min(1.0, max(0.0, share)))
    show(f"{what} {bar:░<20}", end="\r")
