"""Reports to each page on what is reduced because of its link."""

from __future__ import annotations

from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import ToPage
from webviz.server.sending.congestion import CongestionControl

ORDINALS = {1: "st", 2: "nd", 3: "rd"}
SIZES = {2: "half size", 4: "a quarter of their size", 8: "an eighth of their size"}


class SlowLink(ToPage, frozen=True):
    """Says what is reduced because of the link to this page.

    Args:
        text: a sentence, "" if nothing is.
    """

    text: str


class Links:
    """The links to all pages.

    Args:
        channel: to the pages.
    """

    def __init__(self, channel: Channel) -> None:
        self._channel = channel
        self._texts: dict[int, str] = {}

    def tell(self) -> None:
        """Send each page what has changed for it."""
        texts: dict[int, str] = {}
        for browser in self._channel.browsers():
            congestion = self._channel.congestion(browser)
            texts[browser] = "" if congestion is None else reduced(congestion)
            if texts[browser] != self._texts.get(browser, ""):
                self._channel.send(SlowLink(texts[browser]), browser)
        self._texts = texts


def reduced(congestion: CongestionControl) -> str:
    """Return a sentence on what is reduced because of a link; "" if nothing is."""
    parts = []
    if congestion.every > 1:
        parts.append(f"clouds show every {congestion.every}{_ordinal(congestion.every)} point")
    if congestion.shrink > 1:
        parts.append(f"images at {SIZES[congestion.shrink]}")
    if not parts or congestion.rate is None:
        return ""
    return f"Slow link, {_rate(congestion.rate)}: {', '.join(parts)}"


def _rate(bytes_per_second: float) -> str:
    mbit = bytes_per_second * 8e-6
    return f"{mbit:.2g} Mbit/s" if mbit < 10 else f"{mbit:.0f} Mbit/s"


def _ordinal(number: int) -> str:
    return "th" if number % 100 in (11, 12, 13) else ORDINALS.get(number % 10, "th")
