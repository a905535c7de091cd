"""Frames shown by the TF display, and their parents."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Frames


class Pattern(Protocol):
    """A regular expression."""

    def search(self, text: str) -> object:
        """Return a match anywhere in a text, or None."""
        ...


class PatternFault(ValueError):
    """A regular expression that is not valid; the text says why."""


def compiled(text: str) -> Pattern:
    """Return a regular expression, in RE2's syntax.

    Its matching takes linear time. Python's tries all ways: with `(a+)+$` that takes hours for 40
    letters, and stops the frame loop meanwhile.

    Raises:
        PatternFault: it is not valid.
    """
    import re2  # pyright: ignore[reportMissingTypeStubs]  # here, as it takes 1.6 MB

    quiet = re2.Options()
    quiet.log_errors = False
    try:
        return re2.compile(text, quiet)
    except re2.error as error:
        (reason,) = error.args
        raise PatternFault(reason.decode(errors="replace")) from None


class FrameFilter(msgspec.Struct, frozen=True, eq=False):
    """A user's choice of frames.

    Args:
        whitelist: shows only matching names, unless None.
        blacklist: hides matching names.
        switches: by name; they override `default`.
        default: for the frames without a switch.
    """

    whitelist: Pattern | None
    blacklist: Pattern | None
    switches: Mapping[str, bool]
    default: bool

    def select(self, names: Sequence[str]) -> NDArray[np.bool_]:
        """bool (N,): which of the names are shown."""
        return np.array([self._wants(name) for name in names], np.bool_)

    def _wants(self, name: str) -> bool:
        if self.whitelist and not self.whitelist.search(name):
            return False
        if self.blacklist and self.blacklist.search(name):
            return False
        return self.switches.get(name, self.default)


def parent_indices(frames: Frames, names: Sequence[str]) -> NDArray[np.int64]:
    """Place in `names` of each name's newest parent, -1 for roots and frames without data."""
    places = {name: place for place, name in enumerate(names)}
    parents = np.full(len(names), -1, np.int64)
    for place, name in enumerate(names):
        if link := frames.link(name):
            parents[place] = places.get(link.parent, -1)
    return parents
