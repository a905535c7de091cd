"""Calls into a display, which may raise anything."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from webviz.display import Display

log = logging.getLogger("webviz")

CRASHED = object()
"""The result of a hook that raised."""


class Guard:
    """Calls the hooks of one display; what they raise is logged once and remembered.

    Args:
        display: whose hooks.
        strict: let through what they raise, as tests want it.
    """

    def __init__(self, display: Display, strict: bool) -> None:
        self.crashes: dict[str, str] = {}
        """What the last call of each scope raised, if it did."""
        self._display = display
        self._strict = strict

    def __call__(self, scope: str, hook: Callable[..., Any], *args: Any) -> Any:
        """The result of a hook, or `CRASHED`; `scope` tells its calls apart."""
        try:
            result = hook(*args)
        except Exception as error:
            if self._strict:
                raise
            text = f"{type(self._display).__name__} failed: {type(error).__name__}: {error}"
            if self.crashes.get(scope) != text:
                log.exception("%s (%s)", text, self._display.name)
            self.crashes[scope] = text
            return CRASHED
        self.crashes.pop(scope, None)
        return result
