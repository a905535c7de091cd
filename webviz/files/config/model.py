"""What a config holds: settings, and the lists of displays and tools."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

import msgspec

from webviz.api.declared import Color, Prop, make
from webviz.api.display import Display
from webviz.api.group import Group
from webviz.api.registry import display_types, plugin_types
from webviz.api.tool import Tool
from webviz.api.views import Orbit, View

VERSION = 1
STANDARD = ("Grid", "TF", "RobotModel", "LaserScan", "Map", "Path", "Odometry")
"""What is shown when nobody says what to show."""


class Settings(msgspec.Struct, forbid_unknown_fields=True):
    """What a config file says besides its displays."""

    version: Annotated[int, Prop(help="Of the form of the file.")] = VERSION
    fixed_frame: Annotated[str, Prop(help="The frame that everything is drawn in.")] = "map"
    background: Annotated[Color, Prop(help="Colour behind the scene.")] = (48, 48, 48)
    frame_rate: Annotated[
        float, Prop(ge=1, le=240, unit="Hz", help="How often the scene may change.")
    ] = 60.0
    view: View = Orbit()
    """What browsers begin with."""
    views: dict[str, View] = {}
    """Saved views by name."""
    rviz: Annotated[
        dict[str, Any], Prop(help="What a .rviz file says that has no counterpart here.")
    ] = {}  # msgspec copies it
    """Kept for writing it again."""


@dataclass
class Unreadable:
    """A display or tool that cannot be used: kept and saved again as it was written.

    Args:
        values: the entry of the file.
        reason: a sentence with the place of the fault.
    """

    values: Any
    reason: str

    @property
    def name(self) -> str:
        """What lists call it."""
        if isinstance(self.values, Mapping):
            return str(self.values.get("name") or self.values.get("type") or "?")
        return "?"

    @property
    def is_from_rviz(self) -> bool:
        """Whether it is kept of a .rviz file, for want of a counterpart."""
        return isinstance(self.values, Mapping) and "rviz" in self.values

    @property
    def enabled(self) -> bool:
        """Whether the file has it switched on; RViz's displays are off unless it says so."""
        if not isinstance(self.values, Mapping):
            return True
        if not self.is_from_rviz:
            return self.values.get("enabled", True) is not False
        entry = self.values["rviz"]
        entry = entry if isinstance(entry, Mapping) else {}
        return entry.get("Enabled", entry.get("Value", False)) is True


@dataclass
class Branch:
    """A group and what is in it, in order."""

    group: Group
    displays: list[Item]


Item = Display | Unreadable | Branch
"""What a list of displays consists of."""
ToolItem = Tool | Unreadable
"""What a list of tools consists of."""


def all_tools() -> list[ToolItem]:
    """What is in the toolbar without a list of tools: every tool that is installed."""
    return [make(cls, {}) for cls in plugin_types(Tool).values()]


@dataclass
class Config:
    """A whole config.

    Args:
        settings: all but the displays and tools.
        displays: in order.
        tools: in the order of the toolbar.
        report: sentences on what could not be read from RViz's config file.
    """

    settings: Settings = field(default_factory=Settings)
    displays: list[Item] = field(default_factory=list)
    tools: list[ToolItem] = field(default_factory=all_tools)
    report: list[str] = field(default_factory=list)

    def set_fixed_frame(self, frame: str) -> None:
        """Draw in another frame than the file says; a leading slash is no part of its name."""
        fixed_frame = frame.removeprefix("/")
        self.settings = msgspec.structs.replace(self.settings, fixed_frame=fixed_frame)


def standard() -> Config:
    """What is shown without a config file: the usual displays on their usual topics."""
    types = display_types()
    return Config(displays=[make(types[name], {}) for name in STANDARD if name in types])
