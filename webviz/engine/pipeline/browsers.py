"""The interface of the browsers of a scene: their reports, and when they paint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import msgspec

from webviz.api.browser import BrowserSeen


class Painted(msgspec.Struct, frozen=True):
    """The answer of a browser to a probe; times are monotonic, in seconds.

    Args:
        probe: its number.
        browser: id of the browser.
        acknowledged_s: when the page had applied everything before the probe.
        painted_s: when the next frame was on the screen.
    """

    probe: int
    browser: int
    acknowledged_s: float
    painted_s: float


class Browsers(Protocol):
    """The browsers of a scene; see `webviz.scene.browsers.ViserBrowsers`."""

    def reports(self) -> Sequence[BrowserSeen]:
        """All browsers as they reported last."""
        ...

    def probe(self) -> int:
        """Ask all browsers when they paint what was flushed; the number of the probe."""
        ...

    def take_painted(self) -> Sequence[Painted]:
        """Return the answers to probes since the last call."""
        ...

    def count_bytes(self, is_wanted: bool) -> None:
        """Count the bytes that are sent from now on, or no longer."""
        ...

    def bytes_sent(self) -> Mapping[int, Mapping[str, int]]:
        """Return the bytes sent since `count_bytes`, by id of the browser and of the display."""
        ...


class NoBrowsers:
    """The browsers of a scene without any."""

    def reports(self) -> Sequence[BrowserSeen]:
        """None."""
        return ()

    def probe(self) -> int:
        """No effect."""
        return 0

    def take_painted(self) -> Sequence[Painted]:
        """None."""
        return ()

    def count_bytes(self, is_wanted: bool) -> None:
        """No effect."""

    def bytes_sent(self) -> Mapping[int, Mapping[str, int]]:
        """None."""
        return {}
