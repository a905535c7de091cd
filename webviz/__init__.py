"""RViz2 in a browser tab.

This is the API for those who write displays; a display is a function from its properties, messages
and transforms to nodes and statuses.
"""

from webviz.context import Context, Group, Placement
from webviz.display import Color, Display, Input, Keep, Prop, Topic
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

__all__ = [
    "Arrows",
    "Axes",
    "Color",
    "Context",
    "Display",
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
    "compose",
]
