"""Work of a process that is forked from a warm one, see `warm`; it imports little of its own."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

from webviz.shell.cli import ending, program

PATIENCE_S = 180.0
"""Time in seconds for what takes seconds on a machine that does nothing else."""


def run(work: list[str] | str, folder: Path, log: Path) -> None:
    """Do what the script `webviz` does with arguments, or what Python does with a program.

    Args:
        work: the arguments or the text of the program.
        folder: to work in.
        log: file of the output.
    """
    os.chdir(folder)
    os.environ["XDG_STATE_HOME"] = str(log.parent)  # nothing is restored
    file = os.open(log, os.O_WRONLY | os.O_CREAT)
    os.dup2(file, 1)
    os.dup2(file, 2)
    ending.PATIENCE_S = PATIENCE_S  # a busy machine delays what is closed
    if isinstance(work, str):
        signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have ignored it
        exec(work, {"__name__": "__main__"})
    else:
        sys.argv = ["webviz", *work]
        program()
