"""A line of progress in the terminal."""

from webviz.shell.cli.terminal import show


def progress(what: str, share: float) -> None:
    """Show what is done and the share of it; the next line that is written replaces it."""
    bar = "█" * round(20 * min(1.0, max(0.0, share)))
    show(f"{what} {bar:░<20}", end="\r")
