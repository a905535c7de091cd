"""The command line of webviz."""

from __future__ import annotations

import gc
import signal
from collections.abc import Sequence

IMPORTED_OBJECTS = 100_000
"""Objects that are made before the garbage collector runs: imports leave it nothing, and it took a
twelfth of the processor time until the page is served."""


def program() -> None:
    """Run `webviz` and exit. A signal before a command has begun ends the program at once."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # no traceback of the following imports
    gc.set_threshold(IMPORTED_OBJECTS)
    from webviz.shell.cli.ending import finish, leave, on_signal, piped
    from webviz.shell.cli.terminal import claim_output

    claim_output()
    on_signal(leave)
    finish(piped(main))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command, by default that of `sys.argv`, and return its exit status."""
    from webviz.shell.cli.commands import run

    return run(arguments)
