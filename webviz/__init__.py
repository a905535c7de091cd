"""RViz2 in a browser tab.

`Viewer` runs one from a Python program, and `capture` makes pictures. The rest is the API for those
who write displays; a display is a function from its properties, messages and transforms to nodes
and statuses.
"""

import importlib
from typing import TYPE_CHECKING

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
from webviz.sample import Sample
from webviz.status import Level, Status

if TYPE_CHECKING:
    from webviz.app.viewer import Viewer
    from webviz.pictures.capture import capture

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

_LAZY = {"Viewer": "webviz.app.viewer", "capture": "webviz.pictures.capture"}
"""Where lies what takes long to import, and displays have no use for."""


def __getattr__(name: str) -> object:
    if name not in _LAZY:
        raise AttributeError(f"module 'webviz' has no attribute {name!r}")
    return getattr(importlib.import_module(_LAZY[name]), name)


def __dir__() -> list[str]:
    return [*globals(), *_LAZY]
