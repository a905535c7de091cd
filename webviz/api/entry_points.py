"""Entry points of installed packages, which declare plug-ins by them."""

import functools
import importlib.metadata
from collections.abc import Iterable
from typing import Any


def installed(group: str) -> Iterable[importlib.metadata.EntryPoint]:
    """Return the entry points of a group, as of the first call for any."""
    return _all().select(group=group)


@functools.cache
def _all() -> Any:  # of two types, by the version of Python
    """Read the files of all packages, once for all groups."""
    return importlib.metadata.entry_points()
