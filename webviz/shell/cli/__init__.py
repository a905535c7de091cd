"""The command line: `webviz`, and a module for each of its subcommands."""

from __future__ import annotations

from collections.abc import Sequence


def program() -> None:
    """What `webviz` runs, to its end; a signal before a command has begun ends it at once."""
    from webviz.shell.cli.ending import finish, leave, on_signal

    on_signal(leave)
    finish(main())


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command, by default the one that this program was started with.

    Returns:
        The exit status.
    """
    from webviz.shell.cli.main import run

    return run(arguments)
