"""Config: settings, and the lists of displays, tools and panels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import msgspec

from webviz.api.declared import Color, Prop, make
from webviz.api.display import Display
from webviz.api.group import DisplayGroup
from webviz.api.panel import Panel
from webviz.api.registry import plugin_type, plugin_types
from webviz.api.robots import Namespace, NamespacedRobot
from webviz.api.tool import Tool
from webviz.api.views import Orbit, View
from webviz.data.machine_memory import memory_bytes
from webviz.files.config.layout import MAX_LAYOUTS, Layout
from webviz.files.config.robots import Template
from webviz.files.config.watch import WatchLimits, WatchRule

VERSION = 1
STANDARD = ("Grid", "TF", "RobotModel", "LaserScan", "Map", "Path", "Odometry")
"""The displays shown without a config."""


MEMORY_MB = 512
"""Largest size of the memory of live topics in MB, unless the config says more."""

_WORD = "[A-Za-z_*][A-Za-z0-9_*]*"
Name = Annotated[str, msgspec.Meta(max_length=256, pattern=f"^(~?/)?{_WORD}(/{_WORD})*$")]
"""Name of a topic, service or action; `*` stands for any characters."""


class MemorySettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The raw messages of live topics that are kept in memory, whichever bound is met first."""

    seconds: Annotated[float, Prop(ge=0, le=3600, unit="s", help="0 keeps nothing.")] = 60.0
    megabytes: Annotated[
        Annotated[float, msgspec.Meta(ge=0, le=65536)] | None,
        Prop(
            unit="MB",
            help="Total size of the messages; automatic is an eighth of this machine's memory, "
            "at most 512 MB.",
        ),
    ] = None

    @property
    def size_mb(self) -> float:
        """Total size of the messages in MB."""
        if self.megabytes is not None:
            return self.megabytes
        return min(MEMORY_MB, memory_bytes() // 8 // 1_000_000)


class Settings(msgspec.Struct, forbid_unknown_fields=True):
    """A config file without its displays."""

    version: Annotated[int, Prop(help="Version of the file format.")] = VERSION
    fixed_frame: Annotated[str, Prop(help="Frame in which everything is drawn.")] = "map"
    background: Annotated[
        Color | None,
        Prop(
            help="Colour behind the scene; automatic follows the theme of each page, and is RViz's "
            "dark grey in pictures."
        ),
    ] = None
    frame_rate: Annotated[float, Prop(ge=1, le=240, unit="Hz", help="Maximum rate of updates.")] = (
        60.0
    )
    publish: Annotated[
        Annotated[tuple[Name, ...], msgspec.Meta(max_length=1000)] | None,
        Prop(
            help="Topics, services and actions that may be written, instead of those that the "
            "tools, displays and panels use; * matches any characters."
        ),
    ] = None
    robots: Annotated[
        tuple[Namespace | NamespacedRobot, ...],
        msgspec.Meta(max_length=50),
        Prop(help="Namespaces of robots that publish /tf with frames of the same names."),
    ] = ()
    view: Annotated[View, Prop(help="The view new browsers start with.")] = Orbit()
    views: Annotated[
        dict[str, View],
        msgspec.Meta(max_length=1000),
        Prop(help="Saved views by name."),
    ] = {}
    layout: Annotated[Layout, Prop(help="Panels beside, below and over the scene.")] = Layout()
    layouts: Annotated[
        dict[str, Layout],
        msgspec.Meta(max_length=MAX_LAYOUTS),
        Prop(help="Saved layouts by name."),
    ] = {}
    memory: Annotated[
        MemorySettings, Prop(help="Memory of the last minutes, to rewind and save.")
    ] = MemorySettings()
    watch: Annotated[
        tuple[WatchRule, ...],
        msgspec.Meta(max_length=100),
        Prop(help="Rules that save the last minute, and the next 10 s, when they hold."),
    ] = ()
    watch_limits: Annotated[WatchLimits, Prop(help="Limits of the recordings that rules save.")] = (
        WatchLimits()
    )
    bookmarks: Annotated[
        dict[str, float],
        msgspec.Meta(max_length=1000),
        Prop(help="Moments of recordings by name, as stamps in seconds since 1970."),
    ] = {}
    rviz: Annotated[
        dict[str, Any], Prop(help="Unsupported parts of a .rviz file, kept for export.")
    ] = {}  # msgspec copies it


class Unreadable(msgspec.Struct):
    """A display, tool or panel that cannot be used; saving keeps its entry unchanged.

    Args:
        values: the entry of the file.
        reason: a sentence with the place of the error.
    """

    values: Any
    reason: str

    @property
    def name(self) -> str:
        """Its name in lists."""
        if isinstance(self.values, Mapping):
            return str(self.values.get("name") or self.values.get("type") or "?")
        return "?"

    @property
    def is_from_rviz(self) -> bool:
        """Return whether it comes from a .rviz file and its class is unsupported."""
        return isinstance(self.values, Mapping) and "rviz" in self.values

    @property
    def enabled(self) -> bool:
        """Return whether the file enables it; RViz's displays are off by default."""
        if not isinstance(self.values, Mapping):
            return True
        if not self.is_from_rviz:
            return self.values.get("enabled", True) is not False
        entry = self.values["rviz"]
        entry = entry if isinstance(entry, Mapping) else {}
        return entry.get("Enabled", entry.get("Value", False)) is True


class Branch(msgspec.Struct):
    """A group and its displays, in order."""

    group: DisplayGroup
    displays: list[Item]


Item = Display | Unreadable | Branch
"""An entry of a list of displays."""
ToolItem = Tool | Unreadable
"""An entry of a list of tools."""
PanelItem = Panel | Unreadable
"""An entry of a list of panels."""


def all_tools() -> list[ToolItem]:
    """Return the toolbar without a list of tools: every installed tool."""
    types = sorted(plugin_types(Tool).values(), key=lambda cls: cls.order)
    return [make(cls, {}) for cls in types]


def all_panels() -> list[PanelItem]:
    """Return the panels without a list of panels: those installed ones that open at start."""
    by_name = sorted(plugin_types(Panel).items())
    first = sorted(by_name, key=lambda item: getattr(item[1], "place", 100))  # before webviz 0.3
    return [make(cls, {}) for _, cls in first if cls.opens == "at start"]


class Config(msgspec.Struct):
    """A whole config.

    Args:
        settings: everything but the lists.
        displays: in order.
        tools: in the order of the toolbar.
        panels: of plug-ins, in the order of their tabs.
        report: sentences on unsupported parts of a .rviz file.
        templates: of displays and tools, which are saved again as they were read.
    """

    settings: Settings = msgspec.field(default_factory=Settings)
    displays: list[Item] = msgspec.field(default_factory=list)
    tools: list[ToolItem] = msgspec.field(default_factory=all_tools)
    panels: list[PanelItem] = msgspec.field(default_factory=all_panels)
    report: list[str] = msgspec.field(default_factory=list)
    templates: tuple[Template, ...] = ()

    def set_fixed_frame(self, frame: str) -> None:
        """Set another fixed frame; a leading slash is removed from its name."""
        fixed_frame = frame.removeprefix("/")
        self.settings = msgspec.structs.replace(self.settings, fixed_frame=fixed_frame)


def standard() -> Config:
    """Return the config used without a file: the usual displays on their usual topics."""
    types = (plugin_type(Display, name) for name in STANDARD)
    return Config(displays=[make(cls, {}) for cls in types if cls])
