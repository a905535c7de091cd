"""The state of a viewer for panels: a snapshot made by the frame loop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import msgspec

from webviz.api.bridge import Bridge
from webviz.api.context import ColorScale
from webviz.api.display import Display
from webviz.api.finding import Finding
from webviz.api.handles import Handle
from webviz.api.panel import Panel
from webviz.api.status import Level, Status, worst
from webviz.api.tool import Tool
from webviz.api.views import View
from webviz.data.messages.tree import Tree
from webviz.data.transforms import Diagnosis
from webviz.engine.state.config_file import ConfigFile
from webviz.files.config import Settings
from webviz.sources import Offer
from webviz.sources.past_state import (
    Event,
    PlaybackState,
)


class Row(msgspec.Struct, frozen=True):
    """One display in the list.

    Args:
        id: for commands.
        type: name of the display type.
        display: read-only; None if the entry of the config cannot be shown.
        name: as shown.
        statuses: sentences by key.
        depth: number of groups it is in.
        enabled: its own switch, whatever its groups are.
        color_scale: the meaning of its colours.
        revision: how often the display was changed, which is the same object then.
        offered: names for switches, see `Context.offered`.
        attribution: whom to credit for what it draws.
    """

    id: str
    type: str
    display: Display | None
    name: str
    statuses: Mapping[str, Status]
    depth: int = 0
    enabled: bool = True
    color_scale: ColorScale | None = None
    revision: int = 0
    offered: Mapping[str, Mapping[str, int]] = msgspec.field(default_factory=dict)
    attribution: str = ""

    @property
    def level(self) -> Level:
        """The worst of its statuses."""
        return worst(self.statuses.values())


class ClockRate(msgspec.Struct, frozen=True):
    """Rate of ROS time, for pages that count by themselves.

    Args:
        ros_ns, wall_s: ROS time, and wall time in seconds since 1970, of one moment.
        rate: seconds of ROS time per second, 0 while it stands still.
    """

    ros_ns: int = 0
    wall_s: float = 0.0
    rate: float = 0.0

    def at(self, wall_s: float) -> float:
        """ROS time in ns at a wall time."""
        return self.ros_ns + (wall_s - self.wall_s) * self.rate * 1e9


class PanelTimes(msgspec.Struct, frozen=True):
    """The times of RViz's Time panel.

    Args:
        ros_ns: the ROS time that is shown; constant while paused, 0 while unknown.
        wall_s: seconds since 1970.
        ros_elapsed_ns, wall_elapsed_s: since the viewer started or was reset.
        is_paused: whether time is paused.
        pace: how the time that is shown goes on.
        is_simulated: whether ROS time comes from /clock or a bag instead of this machine.
        clock_hz: messages per second on /clock, 0 while ROS time is wall time.
    """

    ros_ns: int = 0
    ros_elapsed_ns: int = 0
    wall_s: float = 0.0
    wall_elapsed_s: float = 0.0
    is_paused: bool = False
    clock_rate: ClockRate = ClockRate()
    is_simulated: bool = False
    clock_hz: float = 0.0


class Traffic(msgspec.Struct, frozen=True):
    """Traffic of a topic over the last seconds.

    Args:
        rate_hz, bytes_per_s: over the last seconds.
        delay_s: how long after its stamp a recent message came, None if it has no stamp.
    """

    rate_hz: float
    bytes_per_s: float
    delay_s: float | None = None


class Inspected(msgspec.Struct, frozen=True):
    """The inspected topic.

    Args:
        type: of its messages, "" without a publisher.
        message: the last one, see `webviz.data.messages.to_tree`; None without one.
        problem: why there is none, or why it cannot be read; a sentence.
        size: of it in bytes.
        received_s: when it came, in seconds of wall time since 1970; 0 without one.
    """

    type: str = ""
    message: Tree | None = None
    problem: str = ""
    size: int = 0
    received_s: float = 0.0


class Between(msgspec.Struct, frozen=True):
    """The transform between two frames, at the newest time that all links between them have.

    Args:
        translation: of the source in the target, in metres; None if there is no transform.
        rotation: (x, y, z, w).
        age_s: how old that time is; None if all links are static, or ROS time is not known.
        problem: why there is no transform, and what to do; a sentence.
    """

    translation: tuple[float, float, float] | None = None
    rotation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
    age_s: float | None = None
    problem: str = ""


class ToolButton(msgspec.Struct, frozen=True):
    """One tool in the toolbar.

    Args:
        id: for commands.
        name: as shown.
        tooltip: one sentence.
        shortcut: the key that selects it, "" for none.
        gesture: followed by the page, see `webviz.api.tool.Tool.gesture`.
        icon: of the page, "" for that of the gesture.
        surface: whether the gesture starts on a surface.
        stays: whether it remains active after a gesture.
        asks: whether pages ask before they send a gesture.
        refusal: why it cannot be used, a sentence; "" if it can.
        several: labels of the buttons that send several poses, () if it takes one.
        tool: read-only.
    """

    id: str
    name: str
    tooltip: str
    shortcut: str
    gesture: str
    icon: str = ""
    surface: bool = False
    stays: bool = False
    asks: bool = False
    refusal: str = ""
    several: tuple[str, ...] = ()
    tool: Tool = msgspec.field(default_factory=Tool)


class PanelTab(msgspec.Struct, frozen=True):
    """One panel of a plug-in.

    Args:
        id: for commands.
        tab: names its tab: its type, with a number from the second of a type on.
        panel: read-only but for its own methods.
    """

    id: str
    tab: str
    panel: Panel


class GoalProgress(msgspec.Struct, frozen=True):
    """A goal that a tool sent to an action.

    Args:
        id: for commands.
        title: name of the tool.
        label: what the goal is, in a few words.
        frame: the fixed frame when it was sent.
        poses: x, y, z in metres and yaw in radians in that frame.
        phase: "sending" until the server accepts it, and "ended" with its outcome.
        status: what is to be said of it, None for nothing.
        values: what its feedback says, texts by label.
        can_dismiss: whether pages may put it away, though the server has not ended it.
    """

    id: str
    title: str
    label: str = ""
    frame: str = ""
    poses: Sequence[tuple[float, float, float, float]] = ()
    phase: Literal["sending", "active", "canceling", "ended"] = "sending"
    status: Status | None = None
    values: Mapping[str, str] = msgspec.field(default_factory=dict)
    can_dismiss: bool = False


class Driving(msgspec.Struct, frozen=True):
    """A vehicle that browsers attend to.

    Args:
        driver: id of the browser that drives, None if none does.
        speed: of the robot in m/s, negative while it backs; None if it is unknown.
        turn_rate: of the robot in rad/s, counter-clockwise; None if it is unknown.
        problem: why they are unknown, with a remedy; "" if they are not.
    """

    driver: int | None = None
    speed: float | None = None
    turn_rate: float | None = None
    problem: str = ""


class Step(msgspec.Struct, frozen=True):
    """Something that was changed.

    Args:
        number: of the change; undo and redo are changes too.
        label: what was done, in a few words.
        browser: that did it, None for a program.
        removed: name of what was removed, "" for other changes.
        restored: what was shown again of the last session, "" for other changes.
    """

    number: int
    label: str
    browser: int | None
    removed: str = ""
    restored: str = ""


class UndoHistory(msgspec.Struct, frozen=True):
    """Undo and redo steps, each with the newest first."""

    undo: tuple[Step, ...] = ()
    redo: tuple[Step, ...] = ()


class State(msgspec.Struct, frozen=True, kw_only=True):
    """A viewer at one moment; each part fills in the fields that it owns.

    Args:
        rows: the displays in order.
        fixed_frame: id of the frame that everything is drawn in.
        frames: all known frame ids, sorted.
        topics: message types by topic name.
        statuses: of the viewer as a whole, such as "Fixed Frame".
        settings: everything in the config except its lists.
        file: of the config.
        clock: the time.
        offers: publishers and QoS by topic name.
        services: types of services by name, as far as the source knows them.
        bridges: to bridges; none without.
        traffic: by topic name, of the topics that are subscribed to.
        inspected: the inspected topics, by name.
        transforms: the tree of transforms, None while no page shows it.
        between: requested transforms, by target and source frame.
        views: what each browser shows, by its id.
        tools, panels: of the toolbar, and of plug-ins, in their order.
        goals: that tools sent to actions, oldest first.
        driving: the vehicles that browsers attend to, by id of their tool.
        handles: what browsers can drag, by id of the display and key, with who holds each.
        history: what can be undone and redone.
        playback: the recording that is played, None for live topics.
        recorded: counts of its messages in equal parts of its span, by topic.
        logged: warnings and errors that its nodes logged, by time.
        warned: when displays began to warn, as far as it was shown, by time.
        findings: of the doctor, the one to repair first at the beginning.
        examined_ns: ROS time of that examination; 0 before the first, or while it is unknown.
        found: when findings began, as far as a recording was shown, by time.
        selected: by browser, ids of things with those of their displays, and whether they move.
        selections: what is known of it, for the browsers that show it.
        more: fields of features, by name; they can be read as those of the state, too.
    """

    rows: tuple[Row, ...] = ()
    fixed_frame: str = Settings().fixed_frame
    frames: tuple[str, ...] = ()
    topics: Mapping[str, tuple[str, ...]] = msgspec.field(default_factory=dict)
    statuses: Mapping[str, Status] = msgspec.field(default_factory=dict)
    settings: Settings = msgspec.field(default_factory=Settings)
    file: ConfigFile = msgspec.field(default_factory=ConfigFile)
    clock: PanelTimes = PanelTimes()
    offers: Mapping[str, Offer] = msgspec.field(default_factory=dict)
    services: Mapping[str, str] = msgspec.field(default_factory=dict)
    bridges: tuple[Bridge, ...] = ()
    traffic: Mapping[str, Traffic] = msgspec.field(default_factory=dict)
    inspected: Mapping[str, Inspected] = msgspec.field(default_factory=dict)
    transforms: Diagnosis | None = None
    between: Mapping[tuple[str, str], Between] = msgspec.field(default_factory=dict)
    views: Mapping[int, View] = msgspec.field(default_factory=dict)
    tools: tuple[ToolButton, ...] = ()
    panels: tuple[PanelTab, ...] = ()
    goals: tuple[GoalProgress, ...] = ()
    driving: Mapping[str, Driving] = msgspec.field(default_factory=dict)
    handles: Mapping[tuple[str, str], tuple[Handle, int | None]] = msgspec.field(
        default_factory=dict
    )
    history: UndoHistory = UndoHistory()
    playback: PlaybackState | None = None
    recorded: Mapping[str, Sequence[int]] = msgspec.field(default_factory=dict)
    logged: Sequence[Event] = ()
    warned: Sequence[Event] = ()
    findings: Sequence[Finding] = ()
    examined_ns: int = 0
    found: Sequence[Event] = ()
    selected: Mapping[int, Mapping[int, tuple[str, bool]]] = msgspec.field(default_factory=dict)
    selections: Mapping[int, Mapping[str, Any]] = msgspec.field(default_factory=dict)
    more: Mapping[str, Any] = msgspec.field(default_factory=dict)

    def __getattr__(self, name: str) -> Any:
        if name in (more := self.more):
            return more[name]
        raise AttributeError(f"a State has no field {name}")
