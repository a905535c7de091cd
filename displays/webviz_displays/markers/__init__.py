"""Markers."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Annotated

import msgspec

from webviz import (
    Context,
    Details,
    Display,
    Frames,
    Hit,
    Input,
    Lookback,
    Prop,
    Sample,
    SelfPlacing,
    Status,
    Topic,
)
from webviz.data import messages
from webviz_displays.markers.actions import deletes_all
from webviz_displays.markers.assets import Assets
from webviz_displays.markers.blocks import Blocks
from webviz_displays.markers.details import marker_details, serial_of
from webviz_displays.markers.report import (
    report_markers,
    report_namespaces,
    report_nothing,
    report_waiting,
)
from webviz_displays.markers.store import Store

__all__ = ["Marker", "MarkerArray"]

SECOND = 1_000_000_000
MAX_NAMES = 1000
"""Namespaces that get a switch in the page."""


class _State(msgspec.Struct):
    """State of what is drawn.

    Args:
        store: all markers, None before the first message.
        blocks: their nodes.
        assets: the files that they name.
        readout: statuses of namespaces and of what waits, and what they were made of.
        ticked_ns: ROS time of the last tick.
    """

    store: Store | None = None
    blocks: Blocks = msgspec.field(default_factory=Blocks)
    assets: Assets = msgspec.field(default_factory=Assets)
    switches: dict[str, bool] = msgspec.field(default_factory=dict)
    readout: tuple[tuple[int, int, int], dict[str, Status]] = ((-1, -1, -1), {})
    ticked_ns: int = 0


class Markers(Display, SelfPlacing):
    """Base of both displays: what differs is their topics."""

    slow_bytes = 1_000_000

    namespaces: Annotated[
        dict[str, bool],
        Prop(
            widget="names",
            help="Switches of single namespaces by name; the markers of others are shown.",
        ),
    ] = msgspec.field(default_factory=dict)

    def new_state(self) -> _State:
        """Nothing drawn."""
        return _State()

    def waits(self, name: str) -> bool:
        """Each marker waits for the transform at its own stamp, so messages need not."""
        return False

    def lookback(self, name: str) -> Lookback:
        """All messages since one that deletes all markers."""
        return Lookback(starts_over=deletes_all)

    def fold(self, name: str, sample: Sample, state: Store | None) -> Store:
        """Take the markers of a message, in order; they are changed in place."""
        store = state or Store()
        message = sample.message
        if isinstance(message, messages.MarkerArray):
            store.apply(message.markers, sample.received_ns)
        else:
            store.apply(messages.MarkerSequence.of([message]), sample.received_ns, is_array=False)
        return store

    def place(self, message: Store, frames: Frames) -> None:
        """Place the versions that have received their transforms."""
        if not message.is_unfinished:
            message.place(frames)

    def depends(self, ctx: Context) -> object:
        """Return what has expired or received its transform since the last tick."""
        state: _State = ctx.state
        if state.store is None:
            return None
        state.store.advance()
        ctx.is_unfinished = state.store.is_unfinished
        if not ctx.is_unfinished:
            state.store.expire(ctx.frames.now_ns)
            state.store.place(ctx.frames)
        return state.store.version, state.assets.version()

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw all markers; the blocks in which none has changed keep their nodes."""
        if not samples:
            return
        state: _State = ctx.state
        store: Store = samples[-1].message
        arrived = state.assets.load(ctx, state.blocks.requests())
        if state.store is not store or state.switches != self.namespaces:
            state.blocks.clear()
            state.store, state.switches = store, dict(self.namespaces)
        ctx.is_unfinished = store.is_unfinished
        if ctx.is_unfinished:  # what was drawn before stays
            changed = set[int]()
        else:
            store.expire(ctx.frames.now_ns)
            store.place(ctx.frames)
            changed, store.changed = store.changed, set()
        state.blocks.renew(store.table, changed, arrived, self._off, state.assets)
        state.assets.start(ctx)
        state.blocks.draw(ctx)
        counts = store.table.namespaces.items()
        ctx.offered["namespaces"] = dict(itertools.islice(counts, MAX_NAMES))
        report_markers(store, state.blocks, self._off, state.assets.loading, ctx)

    def tick(self, ctx: Context) -> None:
        """Report the namespaces, and what waits for a transform."""
        state: _State = ctx.state
        if state.store is None:
            ctx.warn("Markers", "No message received. Start the publisher or choose another topic.")
            return
        now_ns, before_ns = ctx.frames.now_ns, state.ticked_ns
        state.ticked_ns = now_ns
        readout = state.readout[0]
        moment = now_ns, state.store.table.changes, state.store.waiting_count
        is_other_second = readout[0] // SECOND != now_ns // SECOND
        if readout[1:] != moment[1:] or is_other_second or (before_ns == now_ns != readout[0]):
            report_namespaces(state.store, self._off, ctx)
            report_waiting(state.store, ctx)
            state.readout = moment, dict(ctx.statuses)
        ctx.statuses.update(state.readout[1])
        report_nothing(state.store, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a marker."""
        state: _State = ctx.state
        serial = serial_of(hit)
        if state.store is None or serial is None:
            return super().inspect(hit, ctx)
        return marker_details(state.store, serial, ctx.frames.now_ns)

    @property
    def _off(self) -> set[str]:
        """The namespaces that are switched off."""
        return {name for name, is_on in self.namespaces.items() if not is_on}


class Marker(Markers):
    """Shapes, lines, texts and meshes that programs publish one by one, or as arrays."""

    rviz = "rviz_default_plugins/Marker"

    topic: Annotated[
        Topic,
        Input("visualization_msgs/msg/Marker", every=True, unless="array_topic"),
        Prop(help="Topic of the markers."),
    ] = Topic("/visualization_marker")
    array_topic: Annotated[
        Topic,
        Input("visualization_msgs/msg/MarkerArray", suffix="_array", optional=True, every=True),
        Prop(help="Topic of arrays of markers; empty means the topic + _array."),
    ] = Topic()


class MarkerArray(Markers):
    """Shapes, lines, texts and meshes that programs publish as arrays."""

    rviz = "rviz_default_plugins/MarkerArray"

    topic: Annotated[
        Topic,
        Input("visualization_msgs/msg/MarkerArray", every=True),
        Prop(rviz_default="visualization_marker_array", help="Topic of the arrays of markers."),
    ] = Topic("/visualization_marker_array")
