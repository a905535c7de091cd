"""Capabilities that a display opts into with a base class of its own, beside `Display`.

    class Docks(Display, ProtocolClient):
        def talk(self, wire, ctx):
            ...

The pipeline asks for each of them once, when a display starts to run.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar, cast

if TYPE_CHECKING:
    from webviz.api.context import Context
    from webviz.api.evidence import Evidence
    from webviz.api.handles import Grip, Handle
    from webviz.api.sample import Sample
    from webviz.api.wire import Wire


class Selective:
    """A display that decides which samples to hold."""

    __slots__ = ()

    def accept(self, new: Sample, kept: Sequence[Sample]) -> bool | str:
        """Return whether to hold a new sample, given those held of its input (oldest first).

        A text reports why the message cannot be shown.
        """
        return True


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

    def evidence(self, samples: Sequence[Sample], ctx: Context) -> Evidence | None:
        """Return the held samples, oldest first, as inputs of the consistency check.

        The viewer compares it with that of other displays and reports contradictions. Called once
        a second while something of the display is drawn; nodes and statuses added to `ctx` are
        ignored.
        """
        return None


class ProtocolClient:
    """A display that follows a protocol, such as that of a server that has to be asked first."""

    __slots__ = ()

    @property
    def uses(self) -> tuple[str, ...]:
        """The topics it publishes on: they may be written unless the config says otherwise."""
        return ()

    def talk(self, wire: Wire, ctx: Context) -> None:
        """Send and receive.

        Called on every turn of the frame loop while a browser is connected, before the hooks that
        draw; nodes and statuses added to `ctx` are ignored.
        """


class Draggable(ProtocolClient):
    """A protocol client with handles in the scene, which browsers drag."""

    __slots__ = ()

    def handles(self, ctx: Context) -> Mapping[str, Handle]:
        """Return the handles browsers can drag, by key; the same mapping until something changes.

        Called on every turn of the frame loop, after `talk`.
        """
        return {}

    def grip(self, grip: Grip, wire: Wire, ctx: Context) -> None:
        """Take up what a browser does with a handle. One at a time holds it."""


CAPABILITIES = (Comparable, Draggable, ProtocolClient, Selective, Sweep)

C = TypeVar("C", bound=Comparable | ProtocolClient | Selective | Sweep)


def capability(display: object, kind: type[C]) -> C | None:
    """Return a display as one with a capability, None if it has not opted in."""
    if isinstance(display, kind):
        return display
    hooks = [hook for hook in vars(kind) if not hook.startswith("_") and hook != "uses"]
    if not any(callable(getattr(type(display), hook, None)) for hook in hooks):
        return None
    name = type(display).__name__
    warnings.warn(
        f"{name} has {kind.__name__}'s hooks but not its base class, which the next version "
        f"requires. Derive it from webviz.{kind.__name__}, too.",
        DeprecationWarning,
        stacklevel=2,
    )
    return cast("C", _Undeclared(display, kind))


class _Undeclared:
    """A display with some hooks of a capability, but without its base class."""

    def __init__(self, display: object, kind: type) -> None:
        self._display = display
        self._kind = kind

    def __getattr__(self, name: str) -> Any:
        if hasattr(self._display, name):
            return getattr(self._display, name)
        return getattr(self._kind, name).__get__(self._display)
