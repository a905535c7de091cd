"""RViz2 in a browser tab.

`Viewer` runs one from a Python program, and `capture` makes pictures. The rest is the API for those
who write displays; a display is a function from its properties, messages and transforms to nodes
and statuses.
"""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from webviz.api.capabilities import (
        Comparable,
        Draggable,
        ProtocolClient,
        Selective,
        SelfPlacing,
        Sweep,
    )
    from webviz.api.check import Check
    from webviz.api.context import ColorScale, Context, Group, Placement
    from webviz.api.declared import Color, Prop, Topic
    from webviz.api.display import Display, Keep, Sync
    from webviz.api.errors import Error
    from webviz.api.finding import (
        ChangeDisplay,
        Finding,
        HideDisplays,
        Severity,
        Symptom,
        TryYaw,
    )
    from webviz.api.frames import FramePoses, Frames, compose
    from webviz.api.lookback import Lookback
    from webviz.api.nodes import (
        Arrows,
        Axes,
        Glb,
        Image,
        Instances,
        Labels,
        Lines,
        Mesh,
        Models,
        Node,
        Pane,
        Points,
        Pose,
        Rgb,
        Shape,
        Solid,
    )
    from webviz.api.observation import DisplaySeen, InputSeen, Observation
    from webviz.api.panel import Panel, Send, Ui
    from webviz.api.picking import Details, Hit, Quantity
    from webviz.api.ports import Input, Output
    from webviz.api.sample import Sample
    from webviz.api.status import Level, Measurement, OtherFixedFrame, Remedy, Status
    from webviz.api.tool import Gesture, Tool, ToolContext
    from webviz.engine.state import PanelTimes, Row, State, Traffic
    from webviz.shell.app.viewer import Viewer
    from webviz.shell.pictures.capture import capture

__all__ = [
    "Arrows",
    "Axes",
    "ChangeDisplay",
    "Check",
    "Color",
    "ColorScale",
    "Comparable",
    "Context",
    "Details",
    "Display",
    "DisplaySeen",
    "Draggable",
    "Error",
    "Finding",
    "FramePoses",
    "Frames",
    "Gesture",
    "Glb",
    "Group",
    "HideDisplays",
    "Hit",
    "Image",
    "Input",
    "InputSeen",
    "Instances",
    "Keep",
    "Labels",
    "Level",
    "Lines",
    "Lookback",
    "Measurement",
    "Mesh",
    "Models",
    "Node",
    "Observation",
    "OtherFixedFrame",
    "Output",
    "Pane",
    "Panel",
    "PanelTimes",
    "Placement",
    "Points",
    "Pose",
    "Prop",
    "ProtocolClient",
    "Quantity",
    "Remedy",
    "Rgb",
    "Row",
    "Sample",
    "Selective",
    "SelfPlacing",
    "Send",
    "Severity",
    "Shape",
    "Solid",
    "State",
    "Status",
    "Sweep",
    "Symptom",
    "Sync",
    "Tool",
    "ToolContext",
    "Topic",
    "Traffic",
    "TryYaw",
    "Ui",
    "Viewer",
    "capture",
    "compose",
]

_HOMES = {
    "webviz.shell.app.viewer": ("Viewer",),
    "webviz.api.capabilities": (
        "Comparable",
        "Draggable",
        "ProtocolClient",
        "Selective",
        "SelfPlacing",
        "Sweep",
    ),
    "webviz.api.check": ("Check",),
    "webviz.api.context": ("ColorScale", "Context", "Group", "Placement"),
    "webviz.api.declared": ("Color", "Prop", "Topic"),
    "webviz.api.display": ("Display", "Keep", "Sync"),
    "webviz.api.errors": ("Error",),
    "webviz.api.finding": (
        *("ChangeDisplay", "Finding", "HideDisplays"),
        *("Severity", "Symptom", "TryYaw"),
    ),
    "webviz.api.frames": ("FramePoses", "Frames", "compose"),
    "webviz.api.lookback": ("Lookback",),
    "webviz.api.nodes": (
        "Arrows",
        "Axes",
        "Glb",
        "Image",
        "Instances",
        "Labels",
        "Lines",
        "Mesh",
        "Models",
        "Node",
        "Pane",
        "Points",
        "Pose",
        "Rgb",
        "Shape",
        "Solid",
    ),
    "webviz.api.observation": ("DisplaySeen", "InputSeen", "Observation"),
    "webviz.api.panel": ("Panel", "Send", "Ui"),
    "webviz.api.picking": ("Details", "Hit", "Quantity"),
    "webviz.api.ports": ("Input", "Output"),
    "webviz.api.sample": ("Sample",),
    "webviz.api.status": ("Level", "Measurement", "OtherFixedFrame", "Remedy", "Status"),
    "webviz.api.tool": ("Gesture", "Tool", "ToolContext"),
    "webviz.engine.state": ("PanelTimes", "Row", "State", "Traffic"),
    "webviz.shell.pictures.capture": ("capture",),
}
"""Module of each name: imported when it is asked for, since all of it takes a while."""


def __getattr__(name: str) -> object:
    for module, names in _HOMES.items():
        if name in names:
            return getattr(importlib.import_module(module), name)
    raise AttributeError(f"module 'webviz' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *__all__]
