"""A logger that clients cannot flood: single lines, and few of each kind."""

from __future__ import annotations

import logging

INTERVAL = 60.0
"""Seconds in which further lines of the same kind are only counted."""


def rate_limited_log(name: str) -> logging.Logger:
    """Return a child of webviz's logger that is not shared by name."""
    log = logging.Logger(name)
    log.parent = logging.getLogger("webviz")
    log.addFilter(_RateLimitFilter())
    return log


class _RateLimitFilter(logging.Filter):
    """Passes one line of each kind per interval; tracebacks are shortened to one line."""

    def __init__(self) -> None:
        super().__init__()
        self._kinds: dict[str, tuple[float, int]] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        if record.levelno < logging.WARNING:
            return False
        kind = str(record.msg)
        since, left_out = self._kinds.get(kind, (-INTERVAL, 0))
        if record.created - since < INTERVAL:
            self._kinds[kind] = since, left_out + 1
            return False
        self._kinds[kind] = record.created, 0
        text = record.getMessage()
        if record.exc_info and record.exc_info[1] is not None:
            text += f": {_one_line(record.exc_info[1])}"
        if left_out:
            text += f" ({left_out} similar lines omitted)"
        record.msg, record.args = text, ()
        record.exc_info = record.exc_text = None
        return True


def _one_line(error: BaseException) -> str:
    while error.__cause__ is not None:
        error = error.__cause__
    return " ".join(f"{type(error).__name__}: {error}".split())[:200]
