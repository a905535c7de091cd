"""Known state of a server: its markers and the messages for it."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence, Set
from dataclasses import replace

from webviz import Context, Frames
from webviz.api.handles import Handle
from webviz.data.words import shortened
from webviz_displays.interactive_markers.client import Client
from webviz_displays.interactive_markers.completion import MAX_NAME, Completed, RefusedMarker
from webviz_displays.interactive_markers.drawing import MarkerLook, ShownMarker
from webviz_displays.interactive_markers.feedback import FeedbackQueue
from webviz_displays.interactive_markers.reading import MAX_MARKERS, News
from webviz_displays.interactive_markers.tracked import Place, Tracked
from webviz_displays.markers.assets import Assets
from webviz_urdf import LoadRequest

DRAWING_S = 0.05
"""Time in seconds in which new or changed markers are drawn at once; the others follow."""
MAX_IGNORED = 1000
"""Names of ignored messages that are kept."""
MAX_BYTES = 256_000_000
"""Limit in bytes of the lists, texts and files of all markers."""


class InteractiveMarkerServer:
    """An interactive marker server as the display knows it.

    Args:
        namespace: of the server.
        client_id: that it knows this viewer by.
    """

    def __init__(self, namespace: str, client_id: str) -> None:
        self.client = Client(namespace)
        self.client_id = client_id
        self.markers: dict[str, Tracked] = {}
        """Markers by name."""
        self.by_name: dict[str, ShownMarker] = {}
        """Drawn markers, by name."""
        self.assets = Assets()
        """The files that shapes name."""
        self.outgoing = FeedbackQueue()
        self.version = 0
        """Changes with everything that is drawn."""
        self.ignored: dict[str, str] = {}
        """Reasons why messages were ignored, by the name of the marker; sentences."""
        self.left_out = 0
        """Number of markers and poses beyond a limit, since all markers came."""
        self.undrawn = 0
        """Number of markers that the next drawings are for."""
        self.drawings = 0
        """Number of drawings so far."""
        self.is_waiting = False
        """True if something is not drawn because of a missing transform."""
        self._by_key: dict[str, Tracked] = {}
        self._count = 0
        self._size = 0
        """Bytes of the contents of all markers."""
        self._handles: Mapping[str, Handle] = {}
        self._handles_of: object = None
        self._looks: dict[str, tuple[object, Handle]] = {}
        """The handle of each marker by key, and what it was made of."""

    def find(self, key: str) -> Tracked | None:
        """Return the marker of a handle."""
        return self._by_key.get(key)

    def requests(self) -> set[LoadRequest]:
        """Return the files that shapes name."""
        return {
            request for drawn_marker in self.by_name.values() for request in drawn_marker.requests
        }

    def take(self, news: Sequence[News]) -> None:
        """Apply changes in order; within one, markers, then poses, then erased ones."""
        for each in news:
            if each.is_all:
                self._erase(self.markers.keys() - each.markers.keys())
                self.ignored.clear()
                self.left_out = 0
            self.left_out += each.ignored
            for name, marker in each.markers.items():
                self._add(name, marker)
            for name, place in each.poses.items():
                self._move(name, place)
            self._erase(self.markers.keys() & each.erased)
            for name in self.ignored.keys() & each.erased:
                del self.ignored[name]
        self.version += bool(news)

    def draw(self, look: MarkerLook, ctx: Context) -> None:
        """Draw all markers; many that are new or changed are drawn by several calls."""
        arrived = self.assets.load(ctx, self.requests())
        self.drawings += 1
        self.is_waiting = False
        stale: list[tuple[Tracked, Place, ShownMarker]] = []
        for name, marker in self.markers.items():
            drawn_marker, place = self.by_name[name], marker.place(ctx.frames)
            drawn_marker.forget(arrived)
            if place is None:
                self.is_waiting = True
            elif drawn_marker.is_current(marker, place, look, ctx.frames):
                drawn_marker.show(ctx)
            else:
                stale.append((marker, place, drawn_marker))
        stale.sort(key=lambda each: each[2].drawn_in)
        until, count = time.monotonic() + DRAWING_S, 0
        for marker, place, drawn_marker in stale:
            if count and time.monotonic() > until:
                drawn_marker.show(ctx)
                continue
            drawn_marker.draw(marker, place, look, ctx)
            drawn_marker.drawn_in = self.drawings
            count += 1
        self.undrawn = len(stale) - count
        self.is_waiting |= any(
            drawn_marker.transform_error for drawn_marker in self.by_name.values()
        )
        self.assets.start(ctx)

    def handles(self, frames: Frames, aids: bool, refusal: str) -> Mapping[str, Handle]:
        """Return the handles browsers can drag, by key; the same mapping until one changes."""
        of = self.version, frames.fixed_frame, aids, refusal
        if self._handles_of != of:
            self._handles_of = of
            handles: dict[str, Handle] = {}
            for marker in self.markers.values():
                if (place := marker.place(frames)) is None:
                    self._handles_of = None  # until its transform is known
                    continue
                looks = marker.content, tuple(marker.turned.items()), place.frame, aids, refusal
                looked, handle = self._looks.get(marker.key, (None, None))
                if looked != looks or handle is None:
                    handle = _handle(marker, place, aids, refusal)
                handles[marker.key] = handle
                self._looks[marker.key] = looks, handle
            if handles != self._handles:
                self._handles = handles
        return self._handles

    def _add(self, name: str, content: Completed | RefusedMarker) -> None:
        former = self.markers.get(name)
        if isinstance(content, RefusedMarker):
            self._ignore(name, content.reason)
        elif former is None and len(self.markers) >= MAX_MARKERS:
            self.left_out += 1
        elif self._size - (former.content.size if former else 0) + content.size > MAX_BYTES:
            self._ignore(name, f"The markers of this server exceed {MAX_BYTES // 1_000_000} MB.")
        else:
            self.ignored.pop(name, None)
            self._size += content.size - (former.content.size if former else 0)
            if former is not None:
                former.update(content)
                return
            self._count += 1
            marker = Tracked(f"m{self._count}", content)
            self.markers[name] = self._by_key[marker.key] = marker
            self.by_name[name] = ShownMarker(self.assets)

    def _ignore(self, name: str, reason: str) -> None:
        if name in self.ignored or len(self.ignored) < MAX_IGNORED:
            self.ignored[shortened(name, MAX_NAME)] = reason
        else:
            self.left_out += 1

    def _move(self, name: str, place: Place | None) -> None:
        marker = self.markers.get(name)
        if marker is None:
            self._ignore(name, "A pose came for this unknown marker. Correct the server.")
        elif place is None:
            self._ignore(name, "Its new pose is not finite, or too large. Correct the server.")
        else:
            self.ignored.pop(name, None)
            marker.put(place)

    def _erase(self, names: Set[str]) -> None:
        for name in names:
            marker = self.markers.pop(name)
            self._size -= marker.content.size
            del self._by_key[marker.key], self.by_name[name]
            self._looks.pop(marker.key, None)


def _handle(marker: Tracked, place: Place, aids: bool, refusal: str) -> Handle:
    completed = marker.content
    return Handle(
        name=completed.name,
        frame=place.frame,
        controls=tuple(
            replace(part.control, turned=marker.turned.get(part.control.name, 0.0))
            for part in completed.parts
        ),
        menu=completed.menu,
        aids=aids,
        refusal=refusal,
    )
