"""Interactive markers."""

from __future__ import annotations

import math
import re
import secrets
from collections.abc import Mapping, Sequence
from typing import Annotated

import msgspec

from webviz import (
    Context,
    Details,
    Display,
    Draggable,
    Hit,
    Prop,
    Sample,
    Status,
)
from webviz.api.connection import GraphConnection
from webviz.api.handles import Drag, Handle
from webviz.api.ports import Namespace
from webviz.data.words import counted, shortened
from webviz_displays.interactive_markers.completion import MAX_LABEL
from webviz_displays.interactive_markers.drawing import MarkerLook
from webviz_displays.interactive_markers.feedback import (
    BUTTON_CLICK,
    DEPTH,
    FEEDBACK,
    KEEP_ALIVE,
    MENU_SELECT,
    MOUSE_DOWN,
    MOUSE_UP,
    POSE_UPDATE,
    values_of,
)
from webviz_displays.interactive_markers.menus import can_choose
from webviz_displays.interactive_markers.reading import MAX_MARKERS, UPDATE
from webviz_displays.interactive_markers.server import InteractiveMarkerServer
from webviz_displays.interactive_markers.tracked import Tracked

__all__ = ["InteractiveMarkers"]

MAX_ROWS = 20
"""Markers with a status of their own."""


def report(server: InteractiveMarkerServer, refusal: str, ctx: Context) -> None:
    """Report how the connection is, and each marker."""
    status = server.client.status(len(server.markers))
    ctx.statuses["Server"] = status
    if refusal:
        ctx.warn("Feedback", f"Markers cannot be moved from here. {refusal}")
    if server.left_out:
        ignored = counted(server.left_out, "marker")
        ctx.warn("Markers", f"Ignored {ignored} beyond the limit of {MAX_MARKERS}.")
    if loading := server.assets.loading:
        ctx.loading(f"Loading {counted(loading, 'file')} of controls.")
    if server.undrawn:
        ctx.warn("Drawing", f"Drawing {counted(server.undrawn, 'more marker')}.")
    troubles = _troubles(server, ctx)
    if len(troubles) > MAX_ROWS:
        ctx.warn("Others", f"{len(troubles) - MAX_ROWS} more markers have problems.")
    for name, (is_error, text) in list(troubles.items())[:MAX_ROWS]:
        (ctx.error if is_error else ctx.warn)(_key(name, ctx), text)
    for name in list(server.markers.keys() - troubles.keys())[: MAX_ROWS - len(troubles)]:
        marker = server.markers[name]
        place = marker.place(ctx.frames)
        if place is None:
            continue
        if marker.is_locked:
            ctx.ok(_key(name, ctx), f"Locked to frame {place.frame}.")
        else:
            ctx.ok(_key(name, ctx), "Position is fixed.")


def _key(name: str, ctx: Context) -> str:
    """Return the key of the status of a marker, which may be called like another one."""
    label = shortened(name, MAX_LABEL) or "(no name)"
    return f"{label} (marker)" if label in ctx.statuses else label


def _troubles(server: InteractiveMarkerServer, ctx: Context) -> dict[str, tuple[bool, str]]:
    """Return the problems of markers by name: an error or not, and a sentence."""
    troubles = {name: (True, text) for name, text in server.ignored.items()}
    frames = ctx.frames
    for name, marker in server.markers.items():
        if name in troubles:
            continue
        place, source = marker.place(frames), marker.source
        if not source.frame:
            troubles[name] = True, "Its header has no frame id. Correct the server."
        elif place is None:
            troubles[name] = True, frames.why_not(source.frame, source.stamp_ns)
        elif problem := server.by_name[name].transform_error:
            troubles[name] = True, problem
        elif fault := server.by_name[name].fault:
            troubles[name] = True, fault
        elif marker.content.problems:
            troubles[name] = False, marker.content.problems[0]
        elif not marker.content.parts:
            troubles[name] = False, "It has no controls, so only its title is shown."
        elif frames.latest(place.frame) is None:
            troubles[name] = True, frames.why_not(place.frame)
    return troubles


_KEY = re.compile(r"(?:c(\d+)|\w+)/(m\d+)")


def part_of(key: str) -> tuple[str, int | None] | None:
    """Return the key of the marker that a node belongs to, and the index of its control, if any."""
    match = _KEY.match(key)
    return (match[2], None if match[1] is None else int(match[1])) if match else None


def details(marker: Tracked, index: int | None) -> Details:
    """Return a marker, and one of its controls."""
    completed, place = marker.content, marker.source
    values: dict[str, object] = {"Marker": completed.name}
    if completed.description:
        values["Description"] = completed.description
    if index is not None and index < len(completed.parts):
        part = completed.parts[index]
        values["Control"] = part.control.name or "(no name)"
        values["Interaction"] = part.control.mode.replace("_", " ")
        if part.control.help:
            values["Help"] = part.control.help
        if turned := marker.turned.get(part.control.name):
            values["Turned by"] = f"{math.degrees(turned):.1f}°"
    values[f"Pose in {place.frame}"] = place.pose
    values["Scale"] = completed.scale
    return Details(f"Interactive marker {completed.name}", values)


NO_NAMESPACE = "No namespace. Choose that of an interactive marker server."


class _State(msgspec.Struct):
    """State kept between calls.

    Args:
        server: None without a valid namespace.
        problem: why there is none, a sentence.
        refusal: why nothing may be sent to it, a sentence; "" if it may.
        token: tells viewers with nodes of one name apart.
    """

    server: InteractiveMarkerServer | None = None
    problem: str = NO_NAMESPACE
    refusal: str = ""
    token: str = msgspec.field(default_factory=lambda: secrets.token_hex(4))
    reported: tuple[object, Mapping[str, Status]] = (None, {})
    """The last statuses, and when they were made of what."""


class InteractiveMarkers(Display, Draggable):
    """Objects of a server that people move, turn and click, such as goals for a robot arm."""

    rviz = "rviz_default_plugins/InteractiveMarkers"
    offered_for = Namespace("interactive_markers_namespace", UPDATE, "/update")

    interactive_markers_namespace: Annotated[
        str,
        Prop(
            rviz="Interactive Markers Namespace",
            help="Namespace of the server, such as /basic_controls.",
        ),
    ] = ""
    show_descriptions: Annotated[bool, Prop(help="Write the title of each marker above it.")] = True
    show_axes: Annotated[bool, Prop(help="Draw the axes of each marker.")] = False
    show_visual_aids: Annotated[
        bool, Prop(help="Draw the axis along which, or about which, a marker is dragged.")
    ] = False
    enable_transparency: Annotated[
        bool, Prop(help="Use the transparency that the server sets; otherwise opaque.")
    ] = True

    @property
    def uses(self) -> tuple[str, ...]:
        """Feedback, also to servers that are chosen later: such topics have no other use."""
        namespace = self.interactive_markers_namespace.rstrip("/")
        return "/*/feedback", *([f"{namespace}/feedback"] if namespace else [])

    def new_state(self) -> _State:
        """Not connected."""
        return _State()

    def communicate(self, connection: GraphConnection, ctx: Context) -> None:
        """Follow the server, and send it what people do."""
        state: _State = ctx.state
        namespace = self.interactive_markers_namespace.rstrip("/")
        if not namespace:
            state.server, state.problem = None, NO_NAMESPACE
            return
        if state.server is None or state.server.client.namespace != namespace:
            state.server = InteractiveMarkerServer(namespace, f"{connection.node}_{state.token}")
        server, topic = state.server, f"{namespace}/feedback"
        try:
            news = server.client.step(connection)
            state.refusal = connection.advertise(topic, FEEDBACK, DEPTH)
        except ValueError as error:
            state.server, state.problem = None, f"{error}. Correct the namespace."
            return
        server.take(news)
        if (values := server.outgoing.next()) is not None:
            connection.publish(topic, values)
        if server.outgoing or news or server.undrawn:
            connection.wake()

    def depends(self, ctx: Context) -> object:
        """Return the markers, and the transforms that some of them wait for."""
        state: _State = ctx.state
        server = state.server
        if server is None:
            return state.problem
        frames = ctx.frames
        transforms = frames.buffer.version if server.is_waiting else 0
        drawings = server.drawings if server.undrawn else 0
        files = server.assets.version()
        return server, server.version, frames.fixed_frame, transforms, files, drawings

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """All markers, each in groups that move with its frame."""
        state: _State = ctx.state
        if (server := state.server) is None:
            return
        look = MarkerLook(self.show_descriptions, self.show_axes, self.enable_transparency)
        server.draw(look, ctx)

    def tick(self, ctx: Context) -> None:
        """Report the connection and the problems of markers."""
        state: _State = ctx.state
        if (server := state.server) is None:
            ctx.warn("Server", state.problem)
            return
        # Explanations contain times, so they are renewed, but not on every turn.
        progress = server.client.state, bool(server.undrawn)
        moment = server, server.version, progress, state.refusal, ctx.frames.fixed_frame
        second = ctx.frames.now_ns // 500_000_000
        if state.reported[0] != (moment, second):
            report(server, state.refusal, ctx)
            state.reported = (moment, second), dict(ctx.statuses)
        ctx.statuses.update(state.reported[1])

    def handles(self, ctx: Context) -> Mapping[str, Handle]:
        """All markers."""
        state: _State = ctx.state
        if state.server is None:
            return {}
        return state.server.handles(ctx.frames, self.show_visual_aids, state.refusal)

    def drag(self, drag: Drag, connection: GraphConnection, ctx: Context) -> None:
        """Move a marker, and report it to the server as RViz does."""
        state: _State = ctx.state
        server = state.server
        marker = server.find(drag.handle) if server else None
        if server is None or marker is None or drag.control >= len(marker.content.parts):
            return
        part, frames = marker.content.parts[drag.control], ctx.frames
        if part.control.mode == "none" or (
            drag.kind == "choose" and not can_choose(marker.content.menu, drag.entry)
        ):
            return

        def send(event: int, *, is_placed: bool = True, entry: int = 0) -> None:
            point = drag.point if is_placed else None
            values = values_of(
                event, marker, part.control.name, frames, server.client_id, point, entry
            )
            if values is not None:
                server.outgoing.add(values)

        if drag.kind == "press":
            marker.press()
        is_moved = drag.pose is not None and _moves(part.control.mode) and marker.is_held
        if is_moved and drag.pose is not None:
            is_moved = marker.drag(part.control.name, drag.pose, drag.turned, frames)
            server.version += is_moved
        if drag.kind == "press":
            send(POSE_UPDATE, is_placed=False)
            send(MOUSE_DOWN)
        elif drag.kind == "move" and is_moved:
            send(POSE_UPDATE, is_placed=False)
        elif drag.kind == "hold":
            send(KEEP_ALIVE, is_placed=False)
        elif drag.kind == "release":
            if part.control.mode == "button":
                send(BUTTON_CLICK)
            send(POSE_UPDATE, is_placed=False)
            send(MOUSE_UP)
            marker.release()
            server.version += 1
        elif drag.kind == "choose":
            send(MENU_SELECT, entry=drag.entry)
        connection.wake()

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a marker and its control: where it is and what it can do."""
        state: _State = ctx.state
        place = part_of(hit.key)
        marker = state.server.find(place[0]) if state.server and place else None
        return None if marker is None or place is None else details(marker, place[1])


def _moves(mode: str) -> bool:
    return mode.startswith(("move", "rotate"))
