"""A display for tests of the page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

import msgspec

from webviz.api.context import Context
from webviz.api.declared import Color, Prop, Topic
from webviz.api.display import Display, Input
from webviz.api.group import DisplayGroup
from webviz.api.status import Status
from webviz.engine.state import Row
from webviz.files.config import Branch, Item

QUIET = "/scan"
"""The topic that nothing is said of."""


class Arrow(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    length: Annotated[float, Prop(gt=0, unit="m")] = 0.3


class Everything(Display):
    """A display with one property of each kind, which reports what a test has it report."""

    reports_only = True

    reported: ClassVar[dict[str, Mapping[str, Status]]] = {}
    """The statuses of each by its name."""

    topic: Annotated[Topic, Input("sensor_msgs/msg/LaserScan")] = Topic(QUIET)
    frame: Annotated[str, Prop(widget="frame")] = "<Fixed Frame>"
    size: Annotated[float, Prop(gt=0, unit="m", help="Edge of each point.")] = 0.01
    alpha: Annotated[float, Prop(ge=0, le=1)] = 1.0
    count: Annotated[int, Prop(ge=1)] = 3
    style: Literal["Points", "Flat Squares", "Boxes"] = "Points"
    edge: Annotated[float, Prop(gt=0, when=("style", "Boxes"))] = 0.5
    color: Color = (255, 25, 0)
    filled: bool = True
    channel: str = "intensity"
    offset: tuple[float, float, float] = (0.0, 0.5, 0.0)
    prefixes: list[str] = msgspec.field(default_factory=list)
    shown: dict[str, bool] = msgspec.field(default_factory=dict)
    arrow: Arrow = Arrow()

    def listens(self, name: str) -> bool:
        return self.topic.name != QUIET

    def tick(self, ctx: Context) -> None:
        ctx.statuses.update(self.reported.get(self.name, {}))


def named(*names: str) -> list[Everything]:
    """Displays of these names."""
    return [Everything(name=name) for name in names]


def group(name: str, *displays: Item, enabled: bool = True) -> Branch:
    """A group with displays."""
    return Branch(DisplayGroup(name=name, enabled=enabled), list(displays))


def make_row(
    id_: str, name: str = "", statuses: Mapping[str, Status] | None = None, **values: Any
) -> Row:
    """Return a row with a display of every property; the name is its id unless given."""
    display = Everything(name=name or id_, **values)
    return Row(id_, "Everything", display, display.name, statuses or {}, enabled=display.enabled)
