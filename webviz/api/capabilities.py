"""Capabilities that a display opts into with a base class of its own, beside `Display`.

    class Docks(Display, ProtocolClient):
        def communicate(self, connection, ctx):
            ...

The pipeline asks for each of them once, when a display starts to run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from webviz.api.connection import GraphConnection
    from webviz.api.consistency import ConsistencyInput
    from webviz.api.context import Context
    from webviz.api.frames import Frames
    from webviz.api.handles import Drag, Handle
    from webviz.api.sample import Sample


class Selective:
    """A display that decides which samples to hold."""

    __slots__ = ()

    def accept(self, new: Sample, buffered: Sequence[Sample]) -> bool | str:
        """Return whether to hold a new sample, given those held of its input (oldest first).

        A text reports why the message cannot be shown.
        """
        return True


class SelfPlacing:
    """A display that places its own content, such as markers with stamps of their own.

    What a seek passes is not drawn, and its transforms are gone when the seek ends.
    """

    __slots__ = ()

    def places(self, name: str) -> bool:
        """Return whether that takes transforms at the stamps of the input `name`."""
        return True

    def place(self, message: Any, frames: Frames) -> None:
        """Note where that is which now has a transform.

        Called on every turn of the frame loop on which messages or transforms have arrived, whether
        anything is drawn or not.

        Args:
            message: what `fold` has returned last.
            frames: the transforms of the turn.
        """


class Sweep:
    """A display whose messages last, such as the scans of a laser that turns."""

    __slots__ = ()

    def duration_ns(self, message: Any) -> int:
        """Return the duration of a message after its stamp; it waits for transforms until then.

        Messages are decoded as they arrive, those of other displays when drawn.
        """
        return 0


class Comparable:
    """A display that takes part in the consistency check between displays."""

    __slots__ = ()

    def consistency_input(self, samples: Sequence[Sample], ctx: Context) -> ConsistencyInput | None:
        """Return the held samples, oldest first, as inputs of the consistency check.

        The viewer compares it with that of other displays and reports contradictions. Called once
        a second while something of the display is drawn; nodes and statuses added to `ctx` are
        ignored.
        """
        return None


class ProtocolClient:
    """A display with a request and response protocol, such as that of a marker server."""

    __slots__ = ()

    @property
    def uses(self) -> tuple[str, ...]:
        """The topics it publishes on: they may be written unless the config says otherwise."""
        return ()

    def communicate(self, connection: GraphConnection, ctx: Context) -> None:
        """Send and receive.

        Called on every turn of the frame loop while a browser is connected, before the hooks that
        draw; nodes and statuses added to `ctx` are ignored.
        """


class Draggable(ProtocolClient):
    """A protocol client with handles in the scene, which browsers drag."""

    __slots__ = ()

    def handles(self, ctx: Context) -> Mapping[str, Handle]:
        """Return the handles browsers can drag, by key; the same mapping until something changes.

        Called on every turn of the frame loop, after `communicate`.
        """
        return {}

    def drag(self, drag: Drag, connection: GraphConnection, ctx: Context) -> None:
        """Handle a drag. One browser at a time drags a handle."""


CAPABILITIES = (Comparable, Draggable, SelfPlacing, ProtocolClient, Selective, Sweep)

C = TypeVar("C", bound=Comparable | SelfPlacing | ProtocolClient | Selective | Sweep)


def capability(display: object, kind: type[C]) -> C | None:
    """Return a display as one with a capability, None if it has not opted in."""
    return display if isinstance(display, kind) else None
