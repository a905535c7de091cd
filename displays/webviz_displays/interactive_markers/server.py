"""Known state of a server: its markers and the messages for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from webviz import Frames
from webviz.api.handles import Handle
from webviz_displays.interactive_markers.client import Client, News
from webviz_displays.interactive_markers.completion import completed, pose_of
from webviz_displays.interactive_markers.drawing import ShownMarker
from webviz_displays.interactive_markers.feedback import FeedbackQueue
from webviz_displays.interactive_markers.tracked import Place, Tracked
from webviz_displays.markers.assets import Assets
from webviz_urdf import LoadRequest

MAX_MARKERS = 5000


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
        """By name."""
        self.shown: dict[str, ShownMarker] = {}
        """Drawn markers, by name."""
        self.assets = Assets()
        """The files that shapes name."""
        self.outgoing = FeedbackQueue()
        self.version = 0
        """Changes with everything that is drawn."""
        self.ignored: dict[str, str] = {}
        """Why messages were ignored, by the name of the marker; sentences."""
        self.too_many = 0
        self.is_waiting = False
        """True if something is not drawn because of a missing transform."""
        self._by_key: dict[str, Tracked] = {}
        self._made = 0
        self._handles: Mapping[str, Handle] = {}
        self._handles_of: object = None
        self._looks: dict[str, tuple[object, Handle]] = {}
        """The handle of each marker by key, and what it was made of."""

    def find(self, key: str) -> Tracked | None:
        """The marker of a handle."""
        return self._by_key.get(key)

    def requests(self) -> set[LoadRequest]:
        """The files that shapes name."""
        return {request for shown in self.shown.values() for request in shown.requests}

    def take(self, news: Sequence[News]) -> None:
        """Apply changes in order; within one, markers, then poses, then erased ones."""
        for each in news:
            if each.is_all:
                names = {str(message.name) for message in each.markers}
                self._erase([name for name in self.markers if name not in names])
                self.ignored.clear()
                self.too_many = 0
            for message in each.markers:
                self._add(message)
            for message in each.poses:
                self._move(message)
            self._erase(each.erased)
        self.version += bool(news)

    def handles(self, frames: Frames, aids: bool, refusal: str) -> Mapping[str, Handle]:
        """Return the handles browsers can drag, by key; the same mapping until one changes."""
        of = self.version, frames.fixed_frame, aids, refusal
        if self._handles_of != of:
            self._handles_of = of
            found: dict[str, Handle] = {}
            for marker in self.markers.values():
                if (place := marker.place(frames)) is None:
                    self._handles_of = None  # until its transform is known
                    continue
                looks = marker.made, tuple(marker.turned.items()), place.frame, aids, refusal
                looked, handle = self._looks.get(marker.key, (None, None))
                if looked != looks or handle is None:
                    handle = _handle(marker, place, aids, refusal)
                found[marker.key] = handle
                self._looks[marker.key] = looks, handle
            if found != self._handles:
                self._handles = found
        return self._handles

    def _add(self, message: Any) -> None:
        name = str(message.name)
        if name not in self.markers and len(self.markers) >= MAX_MARKERS:
            self.too_many += 1
            return
        made = completed(message)
        self.ignored.pop(name, None)
        if isinstance(made, str):
            self.ignored[name] = made
        elif (known := self.markers.get(name)) is not None:
            known.update(made)
        else:
            self._made += 1
            marker = Tracked(f"m{self._made}", made)
            self.markers[name] = self._by_key[marker.key] = marker
            self.shown[name] = ShownMarker(self.assets)

    def _move(self, message: Any) -> None:
        name = str(message.name)
        pose, marker = pose_of(message.pose), self.markers.get(name)
        if marker is None:
            self.ignored[name] = "A pose came for this unknown marker. Correct the server."
        elif pose is None:
            self.ignored[name] = "Its new pose is not finite, or too large. Correct the server."
        else:
            self.ignored.pop(name, None)
            frame = str(message.header.frame_id).removeprefix("/")
            marker.put(Place(frame, message.header.stamp_ns, pose))

    def _erase(self, names: Sequence[str]) -> None:
        for name in map(str, names):
            self.ignored.pop(name, None)
            if (marker := self.markers.pop(name, None)) is not None:
                del self._by_key[marker.key], self.shown[name]
                self._looks.pop(marker.key, None)


def _handle(marker: Tracked, place: Place, aids: bool, refusal: str) -> Handle:
    made = marker.made
    return Handle(
        name=made.name,
        frame=place.frame,
        controls=tuple(
            replace(part.control, turned=marker.turned.get(part.control.name, 0.0))
            for part in made.parts
        ),
        menu=made.menu,
        aids=aids,
        refusal=refusal,
    )
