"""The state of a viewer for programs, and what it consists of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import msgspec

from webviz.api.context import ColorScale
from webviz.api.display import Display
from webviz.api.panel import Panel
from webviz.api.status import Level, Status, worst
from webviz.api.views import View
from webviz.data.messages.tree import Tree
from webviz.engine.store import PageStore
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
        clock_rate: how the time that is shown goes on.
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


class ConfigFile(PageStore, frozen=True):
    """The file of the config.

    Args:
        path: of the file, "" if there is none.
        is_changed: whether there are unsaved changes.
        folder: base of relative paths.
        others: names of all config files in the folder, sorted.
    """

    path: str = ""
    is_changed: bool = False
    folder: str = ""
    others: tuple[str, ...] = ()


class State(msgspec.Struct, frozen=True, kw_only=True):
    """All that can be read of a viewer, at one moment.

    Args:
        rows: the displays in order.
        frames: all known frame ids, sorted.
        topics: message types by topic name.
        statuses: of the viewer as a whole, such as "Fixed Frame".
        settings: everything in the config except its lists.
        file: of the config.
        clock: the time.
        offers: publishers and QoS by topic name.
        services: types of services by name, as far as the source knows them.
        traffic: by topic name, of the topics that are subscribed to.
        views: what each browser shows, by its id.
        panels: of plug-ins, in their order.
        playback: the recording that is played, None for live topics.
        recorded: counts of its messages in equal parts of its span, by topic.
        logged: warnings and errors that its nodes logged, by time.
        more: what features have, by name; it can be read as if it were fields, too.
    """

    rows: tuple[Row, ...] = ()
    frames: tuple[str, ...] = ()
    topics: Mapping[str, tuple[str, ...]] = msgspec.field(default_factory=dict)
    statuses: Mapping[str, Status] = msgspec.field(default_factory=dict)
    settings: Settings = msgspec.field(default_factory=Settings)
    file: ConfigFile = msgspec.field(default_factory=ConfigFile)
    clock: PanelTimes = PanelTimes()
    offers: Mapping[str, Offer] = msgspec.field(default_factory=dict)
    services: Mapping[str, str] = msgspec.field(default_factory=dict)
    traffic: Mapping[str, Traffic] = msgspec.field(default_factory=dict)
    views: Mapping[int, View] = msgspec.field(default_factory=dict)
    panels: tuple[PanelTab, ...] = ()
    playback: PlaybackState | None = None
    recorded: Mapping[str, Sequence[int]] = msgspec.field(default_factory=dict)
    logged: Sequence[Event] = ()
    more: Mapping[str, Any] = msgspec.field(default_factory=dict)

    @property
    def fixed_frame(self) -> str:
        """Id of the frame that everything is drawn in."""
        return self.settings.fixed_frame

    def __getattr__(self, name: str) -> Any:
        if name in (more := self.more):
            return more[name]
        raise AttributeError(f"a State has no field {name}")


def snapshot(values: Mapping[str, Any]) -> State:
    """Return a state of these values by name; those that are missing have their defaults."""
    own = {name: values[name] for name in State.__struct_fields__ if name in values}
    more = {name: each for name, each in values.items() if not hasattr(State, name)}
    return State(**own, more=more)
