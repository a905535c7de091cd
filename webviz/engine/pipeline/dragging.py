"""The handles of one display, and its protocol client."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from webviz.api.capabilities import Draggable, ProtocolClient, capability
from webviz.api.context import Context
from webviz.api.display import Display
from webviz.api.frames import Frames
from webviz.api.handles import Drag, Handle
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.pipeline.connection import DisplayConnection
from webviz.engine.pipeline.services import DisplayServices
from webviz.sources import Advertisement, Offer, Raw, Subscription

UNSEEN_TURNS = 2
"""Turns without drawing, after which no messages are kept: no browser is connected."""


def reference_group(display: str, frame: str) -> str:
    """Return the group of the scene at a frame, for pages that move a handle in it."""
    return f"{display}/frame of handles/{frame}"


class Dragging:
    """Calls the hooks of a display that follows a protocol or has handles; most have neither.

    Args:
        id: of the display.
        display: that has the hooks, or not.
        services: shared by all.
    """

    def __init__(self, id: str, display: Display, services: DisplayServices) -> None:
        self.handles: Mapping[str, Handle] = {}
        """Handles browsers can drag, by key; another object only after a change."""
        self._id = id
        self._scene = services.scene
        self._connection = DisplayConnection(services, services.graph) if services.graph else None
        self._framed: tuple[Mapping[str, Handle], set[str]] = self.handles, set()
        """Handles, and their frames."""
        self._placed: set[str] = set()
        self._unseen = 0
        self.replace(display)

    def replace(self, display: Display) -> None:
        """Continue with another instance."""
        self._client = capability(display, ProtocolClient)
        self._draggable = capability(display, Draggable)

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the subscriptions of the display."""
        return self._connection.subscriptions() if self._connection else {}

    def topics(self) -> tuple[str, ...]:
        """Return the names of these topics."""
        return self._connection.topics() if self._connection else ()

    def advertisements(self) -> list[Advertisement]:
        """Return the publishers of the display."""
        return self._connection.advertisements() if self._connection else []

    def followed(self) -> set[str]:
        """Return the frames whose poses `communicate` needs."""
        return self._placed

    def is_busy(self) -> bool:
        """Return whether the protocol has not taken the result of slow work yet."""
        return self._connection is not None and self._connection.is_busy()

    def take(self, batches: Mapping[str, Iterable[Raw]], offers: Mapping[str, Offer]) -> None:
        """Keep the messages of this turn."""
        if self._connection is None:
            return
        self._unseen += 1
        if self._unseen > UNSEEN_TURNS:
            self._connection.pause()
        else:
            self._connection.take(batches, offers)

    def communicate(self, boundary: ErrorBoundary, ctx: Context) -> None:
        """Let the display send and receive, and take up its handles."""
        if self._connection is not None and self._client is not None:
            self._unseen = 0
            self._connection.look()
            boundary("communicate", self._client.communicate, self._connection, ctx)
            self._connection.forget_unnamed()
        if self._draggable is not None:
            self.handles = boundary.attempt("handles", {}, self._draggable.handles, ctx)
            self._place(ctx.frames)

    def drag(self, drag: Drag, boundary: ErrorBoundary, ctx: Context) -> None:
        """Pass on what a browser does with a handle."""
        if self._connection is not None and self._draggable is not None:
            boundary("drag", self._draggable.drag, drag, self._connection, ctx)

    def hide(self) -> None:
        """Have no handles, and receive nothing, until the next call of `communicate`."""
        self.handles = {}
        self._remove(self._placed)
        self._placed = set()
        if self._connection is not None:
            self._connection.close()

    def _place(self, frames: Frames) -> None:
        if self._framed[0] is not self.handles:
            handle_frames = {handle.frame for handle in self.handles.values() if handle.frame}
            self._framed = self.handles, handle_frames
        frame_names = self._framed[1]
        for frame in frame_names:
            if pose := frames.latest(frame):
                self._scene.set_pose(reference_group(self._id, frame), pose)
        self._remove(self._placed - frame_names)
        self._placed = frame_names

    def _remove(self, frames: Iterable[str]) -> None:
        for frame in frames:
            self._scene.remove_group(reference_group(self._id, frame))
