"""RViz2 in a browser tab.

`Viewer` runs one from a Python program, and `capture` makes pictures. The rest is the API for those
who write displays; a display is a function from its properties, messages and transforms to nodes
and statuses.
"""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from webviz.app.viewer import Viewer
    from webviz.context import Context, Group, Placement
    from webviz.display import Color, Display, Input, Keep, Prop, Topic
    from webviz.errors import Error
    from webviz.frames import FramePoses, Frames, compose
    from webviz.nodes import (
        Arrows,
        Axes,
        Glb,
        Image,
        Instances,
        Labels,
        Lines,
        Mesh,
        Node,
        Points,
        Pose,
        Rgb,
        Solid,
    )
    from webviz.pictures.capture import capture
    from webviz.sample import Sample
    from webviz.status import Level, Status

__all__ = [
    "Arrows",
    "Axes",
    "Color",
    "Context",
    "Display",
    "Error",
    "FramePoses",
    "Frames",
    "Glb",
    "Group",
    "Image",
    "Input",
    "Instances",
    "Keep",
    "Labels",
    "Level",
    "Lines",
    "Mesh",
    "Node",
    "Placement",
    "Points",
    "Pose",
    "Prop",
    "Rgb",
    "Sample",
    "Solid",
    "Status",
    "Topic",
    "Viewer",
    "capture",
    "compose",
]

_HOMES = {
    "webviz.app.viewer": ("Viewer",),
    "webviz.context": ("Context", "Group", "Placement"),
    "webviz.display": ("Color", "Display", "Input", "Keep", "Prop", "Topic"),
    "webviz.errors": ("Error",),
    "webviz.frames": ("FramePoses", "Frames", "compose"),
    "webviz.nodes": (
        "Arrows",
        "Axes",
        "Glb",
        "Image",
        "Instances",
        "Labels",
        "Lines",
        "Mesh",
        "Node",
        "Points",
        "Pose",
        "Rgb",
        "Solid",
    ),
    "webviz.sample": ("Sample",),
    "webviz.status": ("Level", "Status"),
    "webviz.pictures.capture": ("capture",),
}
"""Where each name comes from: imported when it is asked for, since all of it takes a while."""


def __getattr__(name: str) -> object:
    for module, names in _HOMES.items():
        if name in names:
            return getattr(importlib.import_module(module), name)
    raise AttributeError(f"module 'webviz' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *__all__]
