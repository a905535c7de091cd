"""Pictures for the pages that show them: only those, at their size, and only the newest."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial

import msgspec
from msgspec.structs import replace

from webviz.api.nodes import Pane
from webviz.api.pictures import Encoded, Picture, Pixels, Video
from webviz.data.images import ImageError, decoding, values
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import FramesShown, PixelValue, ReadPixel, ShowPictures
from webviz.server.images.encoding import File, factor_for, file_of
from webviz.server.images.frames import SentPicture, frame
from webviz.server.sending.costs import Costs


def pixel_text(picture: Picture, x: int, y: int) -> str:
    """Return the value of a pixel: depths in metres, colours as red, green and blue; "" if unknown.

    Args:
        picture: of a display.
        x, y: column and row from the upper left corner, from 0.
    """
    if not isinstance(picture, Pixels):
        return ""
    image, layout = picture.image, picture.image.layout
    if not (0 <= x < image.width and 0 <= y < image.height):
        return ""
    with decoding(image.width, image.height, layout.work_bytes):
        value = values(image)[y, x]
    if value.ndim:
        return " ".join(f"{each:.4g}" if each.dtype.kind == "f" else str(each) for each in value)
    if not layout.unit:
        return f"{value:.6g}" if value.dtype.kind == "f" else str(value)
    metres = float(value) / (1000.0 if layout.unit == "mm" else 1.0)
    is_valid = math.isfinite(metres) and not (layout.zero_is_invalid and not value)
    return f"{metres:.3f} m" if is_valid else "no measurement"


MAX_IN_FLIGHT = 2
"""Pictures of a pane that a page has not shown yet: one on its way, one being decoded."""
UNSEEN_S = 2.0
"""A page that is loaded again, or left for a moment, has its pictures at once."""
PICTURE_S = 0.3
"""Seconds of a slow link that one picture of each pane together may take."""
MAX_SHRINK = 8

log = logging.getLogger("webviz")


class _PaneEntry(msgspec.Struct, frozen=True):
    """Picture a display shows now, and its number."""

    number: int
    pane: Pane


class _Look(msgspec.Struct):
    """A page that shows the picture of a display.

    Args:
        width: of it on the screen in pixels.
        sent: number of the newest picture that was sent.
        has: what the page has of what pictures share.
        waiting: numbers of pictures that were sent, and are not shown yet.
        is_busy: whether the next picture is being made.
        turn: alternates with each picture that is sent.
        shrink: by how much pictures are made smaller because of the link.
    """

    width: int
    sent: int = 0
    has: SentPicture = msgspec.field(default_factory=SentPicture)
    waiting: deque[int] = msgspec.field(default_factory=deque)
    is_busy: bool = False
    turn: bool = False
    shrink: int = 1


class Pictures:
    """The pictures of all displays, and the pages that show them.

    `show` and `remove` belong to one thread; pages are heard on the event loop. Pictures are made
    in threads, and sent on the event loop if they are files already: each thread on their way
    would take longer than that.

    Args:
        channel: to the pages.
    """

    def __init__(self, channel: Channel) -> None:
        self._channel = channel
        self.costs: Costs | None = None
        """Counts what is sent while it is there."""
        self._lock = threading.Lock()
        self._pool = ThreadPoolExecutor(max_workers=2, thread_name_prefix="webviz-pictures")
        self._panes: dict[str, _PaneEntry] = {}
        self._looks: dict[int, dict[str, _Look]] = {}
        self._encodings: dict[tuple[str, int], tuple[int, Future[File]]] = {}
        """Pictures by display and factor, made of the newest: pages of one size share it."""
        self._reading: dict[int, Future[None]] = {}
        self._pages: set[int] = set()
        """Pages that have panes, whether or not they show them."""
        self._empty_since: dict[str, float] = {}
        """Times when pages were found not to show a display any more."""
        self._number = 0
        channel.on(ShowPictures, self._look)
        channel.on(FramesShown, self._advance)
        channel.on(ReadPixel, self._read)

    def show(self, display: str, pane: Pane) -> None:
        """Make this the picture of a display."""
        with self._lock:
            self._number += 1
            self._panes[display] = _PaneEntry(self._number, pane)
            looks = self._looks_at(display)
            is_ready = [self._continue(browser, display, look) for browser, look in looks]
        if any(is_ready):
            self._channel.call_soon(partial(self._send_ready, display))

    def remove(self, display: str) -> None:
        """Forget the picture of a display."""
        with self._lock:
            self._panes.pop(display, None)
            self._empty_since.pop(display, None)
            for key in [key for key in self._encodings if key[0] == display]:
                del self._encodings[key]

    def is_unseen(self, display: str) -> bool:
        """Return whether pages have a pane for a display, but none has shown it for `UNSEEN_S`."""
        now = time.monotonic()
        with self._lock:
            self._pages &= self._channel.browsers()
            if not self._pages or any(display in self._looks.get(each, {}) for each in self._pages):
                self._empty_since.pop(display, None)
                return False
            return now - self._empty_since.setdefault(display, now) > UNSEEN_S

    def panes(self) -> dict[str, Pane]:
        """Return the panes shown now by display id, in the order of the displays."""
        with self._lock:
            panes = {display: each.pane for display, each in self._panes.items()}
        return dict(sorted(panes.items(), key=lambda item: item[1].order))

    # Called on the event loop

    def _look(self, browser: int, message: ShowPictures) -> None:
        with self._lock:
            self._pages.add(browser)
            before = self._looks.pop(browser, {})
            looks = {
                display: before.get(display) or _Look(width)
                for display, width in message.widths.items()
            }
            for left in self._looks.keys() - self._channel.browsers():
                del self._looks[left]
            if not looks:
                return
            self._looks[browser] = looks
            for display, look in looks.items():
                if look.width != message.widths[display]:
                    look.width, look.sent = message.widths[display], 0
                    look.has = replace(look.has, picture=None)
        for display in looks:
            self._send_ready(display)

    def _advance(self, browser: int, message: FramesShown) -> None:
        with self._lock:
            looks = self._looks.get(browser, {})
            for display, number in message.numbers.items():
                if (look := looks.get(display)) is not None:
                    while look.waiting and look.waiting[0] <= number:
                        look.waiting.popleft()
        for display in message.numbers.keys() & looks.keys():
            self._send_ready(display)

    def _read(self, browser: int, message: ReadPixel) -> None:
        with self._lock:
            before = self._reading.get(browser)
            entry = self._panes.get(message.display)
            if (before and not before.done()) or entry is None:
                return
            self._reading[browser] = self._pool.submit(self._answer, browser, message, entry.pane)

    def _send_ready(self, display: str) -> None:
        """Send a picture that is a file already to the pages that can take it."""
        with self._lock:
            looks = self._looks_at(display)
            ready = [each for each in looks if self._continue(each[0], display, each[1])]
        for browser, look in ready:
            self._send(browser, display, look)

    # Internal

    def _looks_at(self, display: str) -> list[tuple[int, _Look]]:
        """Return the pages that show a display."""
        return [(page, looks[display]) for page, looks in self._looks.items() if display in looks]

    def _continue(self, browser: int, display: str, look: _Look) -> bool:
        """Make the next picture for a page in a thread, if there is one that the page can take.

        Returns:
            Whether it is a file already, which `_send_ready` sends.
        """
        entry = self._panes.get(display)
        if entry is None or entry.number == look.sent:
            return False
        if look.is_busy or len(look.waiting) >= MAX_IN_FLIGHT:
            return False
        picture = entry.pane.picture
        is_file = isinstance(picture, Encoded | Video) or look.has.has(picture)
        if is_file and self._rate(browser) is None:
            return True
        look.is_busy = True
        self._pool.submit(self._send, browser, display, look)
        return False

    def _send(self, browser: int, display: str, look: _Look) -> None:
        """Send the newest picture."""
        with self._lock:
            entry = self._panes.get(display)
            has = look.has
            rate = self._rate(browser)
        data = b""
        if entry is not None:
            try:
                is_same, now_has = has.has(entry.pane.picture), has
                for _ in range(2):
                    file = None if is_same else self._file(entry, display, look)
                    data, now_has = frame(display, entry.number, entry.pane, file, has)
                    if is_same or not self._fit(look, entry, len(data), rate):
                        break
                has = now_has
            except Exception:
                log.exception("A picture of %r could not be made", display)
        with self._lock:
            look.is_busy = False
            if entry is None or self._looks.get(browser, {}).get(display) is not look:
                return
            look.sent, look.has = entry.number, has
            if data:
                look.waiting.append(entry.number)
                # Two at most are on their way, neither of which may replace the other there: later
                # ones go on from what they say.
                look.turn = not look.turn
                self._channel.send_bytes(data, f"{display} {look.turn:d}", browser)
                if self.costs is not None:
                    self.costs.add(browser, {display: len(data)})
            is_ready = self._continue(browser, display, look)
        if is_ready:
            self._channel.call_soon(partial(self._send_ready, display))

    def _rate(self, browser: int) -> float | None:
        """Bytes a second for each picture of a page; None on a link that is fast enough."""
        looks = self._looks.get(browser, {})
        congestion = self._channel.congestion(browser)
        if congestion is None:
            return None
        congestion.shrink = max((look.shrink for look in looks.values()), default=1)
        return None if congestion.rate is None else congestion.rate / max(1, len(looks))

    @staticmethod
    def _fit(look: _Look, entry: _PaneEntry, size: int, rate: float | None) -> bool:
        """Adapts how much smaller pictures are made; whether this one is much too large."""
        if rate is None or not isinstance(entry.pane.picture, Pixels | Encoded):
            look.shrink = 1
            return False
        excess = size / (rate * PICTURE_S)
        before = look.shrink
        while excess > 1.0 and look.shrink < MAX_SHRINK:
            look.shrink, excess = look.shrink * 2, excess / 4
        if look.shrink == before > 1 and excess < 0.15:
            look.shrink //= 2
        return look.shrink > before

    def _file(self, entry: _PaneEntry, display: str, look: _Look) -> File | None:
        """Return the picture a page decodes, None for video; made once for all pages of a size."""
        picture = entry.pane.picture
        if isinstance(picture, Video):
            return None
        factor = factor_for(picture, look.width) * look.shrink
        if not isinstance(picture, Pixels) and factor == 1:
            return file_of(picture, factor)
        key = display, factor
        with self._lock:
            number, encoding = self._encodings.get(key, (0, None))
            if encoding is not None and number == entry.number:
                mine = None
            else:
                mine = encoding = Future()
                self._encodings[key] = entry.number, encoding
        if mine is not None:
            try:
                mine.set_result(file_of(picture, factor))
            except Exception as error:
                mine.set_exception(error)
        return encoding.result()

    def _answer(self, browser: int, message: ReadPixel, pane: Pane) -> None:
        try:
            text = pixel_text(pane.picture, message.x, message.y)
        except ImageError:
            return
        self._channel.send(PixelValue(message.display, message.x, message.y, text), browser)
