"""A line of progress in the terminal."""

import sys


def progress(what: str, share: float) -> None:
    """Show what is done and the share of it; the next line that is written replaces it."""
    if sys.stderr.isatty():
        bar = "█" * round(20 * min(1.0, max(0.0, share)))
        print(f"\r{what} {bar:░<20}\x1b[K\r", end="", file=sys.stderr, flush=True)
