"""Copies of displays and groups."""

from __future__ import annotations

import copy
import itertools
import re
from typing import TypeVar

from webviz.api.declared import make, to_values
from webviz.api.display import Display
from webviz.files.config import Branch, Item, Unreadable

D = TypeVar("D", bound=Display)


def copy_of(item: Item, names: set[str]) -> Item:
    """Return a copy of a display, or of a group with its contents, under an unused name.

    Args:
        item: to copy.
        names: of all displays.
    """
    copied = _copy(item)
    if not isinstance(copied, Unreadable):
        own = copied.group if isinstance(copied, Branch) else copied
        own.name = _fresh(own.name, names)
    return copied


def _copy(item: Item) -> Item:
    if isinstance(item, Branch):
        return Branch(_copied(item.group), [_copy(each) for each in item.displays])
    return copy.deepcopy(item) if isinstance(item, Unreadable) else _copied(item)


def _copied(display: D) -> D:
    return make(type(display), to_values(display))


def _fresh(name: str, taken: set[str]) -> str:
    """Return an unused name: `Scan 2` for `Scan`."""
    stem = re.sub(r" \d+$", "", name)
    return next(n for i in itertools.count(2) if (n := f"{stem} {i}") not in taken)
