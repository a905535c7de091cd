"""Calls whose exceptions must not end the frame loop, behind an error boundary."""

from __future__ import annotations

import logging
import math
import time
import traceback
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from webviz.api.status import Level, Status
from webviz.data.words import joined

log = logging.getLogger("webviz")

T = TypeVar("T")

CRASHED = object()
"""The result of a call that raised an exception."""
MAX_CHARACTERS = 500
"""Largest number of characters of the text of an exception."""


class ErrorBoundary:
    """Calls hooks of a display or parts of the viewer; each exception is logged once.

    Args:
        who: subject of the error message; "" is the scope of the call.
        strict: let exceptions through, for tests.
        name: added to the log, to distinguish displays of one type.
        shown_s: how long a crash is shown; None is until the next call of its scope succeeds.
        clock: monotonic time in seconds.
    """

    def __init__(
        self,
        who: str,
        strict: bool,
        *,
        name: Callable[[], str] = str,
        shown_s: float | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._who = who
        self._strict = strict
        self._name = name
        self._shown_s = shown_s
        self._clock = clock
        self._crashes: dict[str, tuple[str, float]] = {}
        self._logged: set[object] = set()

    @property
    def crashes(self) -> Mapping[str, str]:
        """Recent exceptions, one sentence per scope."""
        since = -math.inf if self._shown_s is None else self._clock() - self._shown_s
        return {scope: text for scope, (text, at) in self._crashes.items() if at >= since}

    def statuses(self) -> dict[str, Status]:
        """Return the same as errors of a viewer."""
        return {
            scope: Status(Level.ERROR, joined(text, "The log has the details; please report this."))
            for scope, text in self.crashes.items()
        }

    def __call__(self, scope: str, call: Callable[..., Any], *args: Any) -> Any:
        """Return the result of a call, or `CRASHED`; `scope` distinguishes calls."""
        try:
            result = call(*args)
        except (Exception, SystemExit) as error:  # a plug-in may call sys.exit
            self.note(scope, error)
            return CRASHED
        if self._shown_s is None:
            self._crashes.pop(scope, None)
        return result

    def note(self, scope: str, error: BaseException) -> str:
        """Log an exception, if it is new, and return its sentence in `crashes`.

        Raises:
            BaseException: the error itself, if the boundary is strict.
        """
        if self._strict:
            raise error
        text = f"{self._who or scope} failed: {_in_words(error)}"
        self._log(text, error)
        self._crashes[scope] = text, self._clock()
        return text

    def attempt(self, scope: str, otherwise: T, call: Callable[..., T], *args: Any) -> T:
        """Return the result of a call, or `otherwise`."""
        result = self(scope, call, *args)
        return otherwise if result is CRASHED else result

    def _log(self, text: str, error: BaseException) -> None:
        """Log once per line of code that raises; its text may change with every call."""
        *_, (frame, line) = traceback.walk_tb(error.__traceback__)
        origin = type(error), frame.f_code, line
        if origin not in self._logged:
            self._logged.add(origin)
            name = self._name()
            log.error("%s", f"{text} ({name})" if name else text, exc_info=error)


def _in_words(error: BaseException) -> str:
    kind = type(error).__name__
    try:
        text = " ".join([str(error), *getattr(error, "__notes__", ())]).strip()
    except Exception:  # __str__ of a plug-in's exception
        text = ""
    return f"{kind}: {text[:MAX_CHARACTERS]}" if text else f"{kind}."
