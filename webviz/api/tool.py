"""The base class of tools: declared properties, and an action on a finished gesture.

    class GoalPose(Tool):
        \"\"\"Send the robot to a pose: press at the position, drag towards the heading.\"\"\"

        shortcut, gesture = "g", "pose"

        topic: Annotated[Topic, Output("geometry_msgs/msg/PoseStamped")] = Topic("/goal_pose")

        def done(self, gesture, ctx):
            ctx.publish("topic", {"header": ctx.header, ...})

The page follows the gesture and draws its preview itself; the tool gets the finished `Gesture`.
"""

from __future__ import annotations

import functools
import math
import warnings
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal

import msgspec

from webviz.api.declared import Declared, Prop, Topic
from webviz.api.frames import Frames
from webviz.api.goal import GoalRequest, goal_request, nothing
from webviz.api.ports import Output
from webviz.api.properties import ports_of
from webviz.api.status import Level, Status
from webviz.api.vehicle import Vehicle
from webviz.data.messages import encode, interfaces

GestureKind = Literal["point", "pose", "drive"]
"""A click on a position, a drag from a position towards a heading, or keys and sticks that are
held to drive the `vehicle` of the tool. A tool with a `module` may have one of its own."""

Confirm = Annotated[bool, Prop(help="Ask before a gesture is sent.")]
"""The property `confirm` of a tool: its preview stays until it is sent or cancelled."""

Position = tuple[float, float, float]


@dataclass(frozen=True)
class Gesture:
    """A finished gesture.

    Args:
        points: its path from start to end, at least one point: x, y and z in metres in the fixed
            frame. z is 0 unless the tool takes points of surfaces or the gesture was lifted.
        yaw: the heading of a pose in radians, 0 for a click.
        keys: the held modifier keys: "shift", "ctrl", "alt", "meta".
        browser: id of the browser; None for a program.
        yaws: the headings of poses that were collected, one for each point; otherwise ().
        several: the button that sent them, one of `Tool.several`; otherwise "".
    """

    points: tuple[Position, ...]
    yaw: float = 0.0
    keys: frozenset[str] = frozenset()
    browser: int | None = None
    yaws: tuple[float, ...] = ()
    several: str = ""

    @property
    def position(self) -> Position:
        """The start of the gesture, in metres in the fixed frame."""
        return self.points[0]

    @property
    def point(self) -> dict[str, float]:
        """The position as the values of a geometry_msgs/Point."""
        return dict(zip("xyz", self.position, strict=True))

    @property
    def pose(self) -> dict[str, dict[str, float]]:
        """Position and heading as the values of a geometry_msgs/Pose."""
        return _pose(self.position, self.yaw)

    @property
    def poses(self) -> list[dict[str, dict[str, float]]]:
        """The poses that were collected, or the only one, as the values of geometry_msgs/Pose."""
        if not self.several:
            return [self.pose]
        return list(map(_pose, self.points, self.yaws))


def _pose(position: Position, yaw: float) -> dict[str, dict[str, float]]:
    point = dict(zip("xyz", position, strict=True))
    return {"position": point, "orientation": {"z": math.sin(yaw / 2.0), "w": math.cos(yaw / 2.0)}}


class ToolContext:
    """The context of a tool for one gesture.

    Args:
        frames: the current transforms.
        now_ns: ROS time, which advances while the page is paused.
        publish: sends a message from an output of the tool, encoded and as its values, and reports
            the result.
        call: sends an encoded request to a service: name, type, request, timeout in seconds.
        send_goal: sends a goal to an action.
        report: reports to the browser that made the gesture.
    """

    def __init__(
        self,
        tool: Tool,
        frames: Frames,
        now_ns: int,
        publish: Callable[[str, bytes, Mapping[str, Any]], None],
        call: Callable[[str, str, bytes, float], Future[bytes]],
        send_goal: Callable[[GoalRequest], None],
        report: Callable[[Status], None],
    ) -> None:
        self.frames = frames
        self.now_ns = now_ns
        self._tool = tool
        self._publish = publish
        self._call = call
        self._send_goal = send_goal
        self._report = report

    @property
    def fixed_frame(self) -> str:
        """The frame of the points of a gesture."""
        return self.frames.fixed_frame

    @property
    def header(self) -> dict[str, Any]:
        """The values of a std_msgs/Header in the fixed frame, now."""
        sec, nanosec = divmod(self.now_ns, 1_000_000_000)
        return {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": self.fixed_frame}

    def publish(self, output: str, values: Mapping[str, Any]) -> None:
        """Publish a message, and report the number of subscriptions.

        Args:
            output: name of the property with the topic.
            values: of the message by field; missing fields have their defaults.

        Raises:
            EncodeError: a value does not fit the message definition.
        """
        payload = encode(outputs_of(type(self._tool))[output].type, values)
        self._publish(output, payload, values)

    def call(
        self,
        service: str,
        type: str,
        request: Mapping[str, Any],
        *,
        definition: str = "",
        answered: Callable[[Any], None] | None = None,
        timeout_s: float = 5.0,
    ) -> None:
        """Call a service, and report why it did not respond.

        Args:
            service: its name; remapped like a topic.
            type: such as "std_srvs/srv/SetBool".
            request: values by field; missing fields have their defaults.
            definition: text of the .srv file, for types unknown to webviz.
            answered: called with the response from another thread; must not block. Without it, the
                response is reported as such.
            timeout_s: for service and response to appear.

        Raises:
            EncodeError: a value does not fit the request.
            UnknownTypeError: the message type has no known definition.
        """
        parts = interfaces.service(type, definition)

        take = answered or (lambda _: self.ok(f"{service} responded."))
        response = self._call(service, type, encode(parts.request, request), timeout_s)
        response.add_done_callback(interfaces.taker(service, parts.response, take, self.error))

    def send_goal(
        self,
        action: str,
        type: str,
        goal: Mapping[str, Any],
        *,
        definition: str = "",
        label: str = "",
        gesture: Gesture | None = None,
        remedy: str = "Start its node, or choose another name.",
        success: str = "Succeeded.",
        feedback: Callable[[Any], Mapping[str, str]] | None = None,
        fault: Callable[[Any], str] = nothing,
        stroke: Gesture | None = None,
    ) -> None:
        """Send a goal to an action. All pages show its progress; every operator can cancel it.

        It replaces the previous goal of the tool: the server of the same action preempts that one,
        at another action it is cancelled first.

        Args:
            action: its name; remapped like a topic.
            type: such as "nav2_msgs/action/NavigateToPose".
            goal: values by field; missing fields have their defaults.
            definition: text of the .action file, for types unknown to webviz.
            label: what the goal is, in a few words.
            gesture: whose poses pages show while the goal is active.
            remedy: what to do if no node offers the action; a sentence.
            success: what to report if it succeeds without a fault; a sentence.
            feedback: called with the newest feedback; returns what to show of it, texts by label.
            fault: called with the result; returns what went wrong, "" for nothing; a sentence.
            stroke: the former name of `gesture`.

        `feedback` and `fault` are called by the frame loop.

        Raises:
            EncodeError: a value does not fit the goal.
            UnknownTypeError: the message type has no known definition.
        """
        if stroke is not None:
            warnings.warn("send_goal's stroke is gesture now.", DeprecationWarning, stacklevel=2)
            gesture = stroke
        yaws = (gesture.yaws or (gesture.yaw,)) if gesture else ()
        points = gesture.points if gesture else ()  # a drag has its end, too
        poses = [(*point, yaw) for point, yaw in zip(points, yaws, strict=False)]
        self._send_goal(
            goal_request(
                action,
                type,
                goal,
                definition=definition,
                label=label,
                poses=poses,
                remedy=remedy,
                success=success,
                feedback=feedback,
                fault=fault,
            )
        )

    def ok(self, text: str) -> None:
        """Report a result to the browser that made the gesture."""
        self._report(Status(Level.OK, text))

    def warn(self, text: str) -> None:
        """Report a warning, with its remedy."""
        self._report(Status(Level.WARN, text))

    def error(self, text: str) -> None:
        """Report an error, with its remedy."""
        self._report(Status(Level.ERROR, text))


class Tool(Declared, kw_only=True):
    """Base of all tools. The first line of the docstring is the tooltip of its button."""

    kind = "tool"
    shortcut: ClassVar[str] = ""
    """The key that selects it, a lower-case letter; "" is none."""
    icon: ClassVar[str] = ""
    """An icon as that of a display (`Display.icon`), "" for that of its gesture."""
    rviz_panel: ClassVar[str] = ""
    """The class of the panel that does the same in RViz; its `Topic` is the property `topic`."""
    order: ClassVar[int] = 100
    """Place in a toolbar that no config orders; those of webviz come first, as in RViz."""
    gesture: ClassVar[GestureKind | str] = "point"
    surface: ClassVar[bool] = False
    """True if a gesture starts on the surface under the pointer instead of on the ground, the plane
    z = 0 of the fixed frame."""
    several: ClassVar[tuple[str, ...]] = ()
    """Labels of the buttons that send several poses, which the page collects; () for one pose per
    gesture."""

    name: Annotated[str, msgspec.Meta(description="Shown in the toolbar.")] = ""

    @property
    def stays(self) -> bool:
        """Return whether it remains the active tool after a gesture."""
        return False

    @property
    def asks(self) -> bool:
        """Return whether pages ask before they send a gesture, as its property `confirm` says."""
        return getattr(self, "confirm", False)

    @property
    def uses(self) -> tuple[str, ...]:
        """The services and actions it sends to.

        They may be written unless the config says otherwise, and its button says if they may not.
        """
        return ()

    @property
    def vehicle(self) -> Vehicle | None:
        """Return the vehicle, with the present properties; None unless its gesture is "drive"."""
        return None

    def done(self, gesture: Gesture, ctx: ToolContext) -> None:
        """Act on a finished gesture; called by the frame loop."""


@functools.cache
def outputs_of(cls: type[Tool]) -> dict[str, Output]:
    """Return the outputs of a tool class by property name, in the order of declaration."""
    return {name: port for name, port in ports_of(cls).items() if isinstance(port, Output)}


def outputs(tool: Tool) -> list[tuple[str, Output, Topic]]:
    """Each output of a tool: property name, declaration, and the topic chosen for it."""
    return [(name, spec, getattr(tool, name)) for name, spec in outputs_of(type(tool)).items()]
