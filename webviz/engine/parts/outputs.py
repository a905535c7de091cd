"""Files that a viewer wrote for people: recordings, reports and shared moments."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import msgspec

from webviz.engine.commands import Sender

MAX_OUTPUTS = 20

Kind = Literal["recording", "report", "shared"]


class OutputFile(msgspec.Struct, frozen=True):
    """A file or folder that is complete.

    Args:
        number: counts them.
        path: absolute.
        kind: of the file.
        text: what it is, a sentence.
        browser: that asked for it, None for programs.
    """

    number: int
    path: Path
    kind: Kind
    text: str
    browser: int | None


class Outputs:
    """The newest files; the frame loop adds them, any thread reads them."""

    def __init__(self) -> None:
        self._count = 0
        self._newest: deque[OutputFile] = deque(maxlen=MAX_OUTPUTS)
        self.all: Sequence[OutputFile] = ()
        """The oldest first."""

    def add(self, path: Path, kind: Kind, text: str, sender: Sender) -> None:
        """Note a file that was written."""
        self._count += 1
        output = OutputFile(self._count, path.absolute(), kind, text, sender.browser)
        self._newest.append(output)
        self.all = tuple(self._newest)

    def find(self, number: int) -> OutputFile | None:
        """Return the one with a number; None if it is not known any more."""
        return next((each for each in self.all if each.number == number), None)
