"""Things that a test makes as many of as it likes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from operator import methodcaller
from typing import Any, TypeVar

T = TypeVar("T")
Make = Callable[..., Any]
"""A fixture that makes a thing at each call."""


@contextmanager
def several(
    make: Callable[..., T], end: Callable[[T], object] = methodcaller("close")
) -> Iterator[Callable[..., T]]:
    """Let `make` be called again and again, and end all that it made, the newest first."""
    with ExitStack() as stack:

        def make_one(*args: Any, **options: Any) -> T:
            one = make(*args, **options)
            stack.callback(end, one)
            return one

        yield make_one
