"""The MapGraph display."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from webviz import (
    Color,
    Context,
    Details,
    Display,
    Hit,
    Input,
    Pose,
    Prop,
    Sample,
    Topic,
    compose,
)
from webviz.data.words import counted
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import is_drawable, origin_near
from webviz_displays.shared.properties import opaque

KINDS = (
    "neighbor",
    "global_loop_closure",
    "local_loop_closure",
    "local_loop_closure",
    "user",
    "virtual",
    "merged_neighbor",
    "global_loop_closure",
    "landmark",
)
"""Properties with the colour of a link, by its type in RTAB-Map's Link.h; others are as 1."""


class MapGraph(Display):
    """The graph of poses that RTAB-Map optimizes: its links, coloured by what they come from."""

    rviz = "rtabmap_rviz_plugins/MapGraph"

    topic: Annotated[
        Topic, Input("rtabmap_msgs/msg/MapGraph"), Prop(help="Topic of the graphs.")
    ] = Topic("/rtabmap/mapGraph")
    neighbor: Annotated[Color, Prop(help="Colour of links by odometry.")] = (0, 0, 255)
    merged_neighbor: Annotated[
        Color, Prop(rviz="Merged neighbor", help="Colour of links by odometry that were merged.")
    ] = (255, 170, 0)
    global_loop_closure: Annotated[
        Color, Prop(rviz="Global loop closure", help="Colour of loops found by appearance.")
    ] = (255, 0, 0)
    local_loop_closure: Annotated[
        Color, Prop(rviz="Local loop closure", help="Colour of loops found nearby.")
    ] = (255, 255, 0)
    landmark: Annotated[Color, Prop(help="Colour of links to landmarks.")] = (0, 128, 0)
    user: Annotated[Color, Prop(help="Colour of links that users added.")] = (255, 0, 0)
    virtual: Annotated[Color, Prop(help="Colour of virtual links.")] = (255, 0, 255)
    alpha: Annotated[Alpha, Prop(help="Opacity of the links.")] = 1.0

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw the links between known poses, in the frame and at the stamp of the header."""
        message = sample.message
        count = len(message.poses_id)
        if len(message.poses) != count:
            text = f"{len(message.poses)} poses for {count} ids. Fix the publisher."
            ctx.error("Graph", text)
            return
        places = message.poses.positions
        rows = {int(id): row for row, id in enumerate(message.poses_id)}
        is_good = is_drawable(places)
        numbers = np.array(
            [
                number
                for number, link in enumerate(message.links)
                if _is_known(link.from_id, rows, is_good) and _is_known(link.to_id, rows, is_good)
            ],
            np.int64,
        )
        left_out = len(message.links) - len(numbers)
        amounts = f"{counted(count, 'pose')}, {counted(len(numbers), 'link')}"
        if left_out:
            ctx.warn(
                "Graph", f"{amounts}; {left_out} left out: their poses are missing or invalid."
            )
        elif not len(numbers):
            ctx.warn("Graph", f"{amounts}: nothing to draw. Wait until the robot has moved.")
        elif self.alpha == 0:
            ctx.warn("Graph", "Invisible: alpha is 0. Increase it to show the links.", opaque())
        else:
            ctx.ok("Graph", f"{amounts}.")
        if not len(numbers) or self.alpha == 0:
            return
        links = [message.links[number] for number in numbers]
        ends = [(rows[link.from_id], rows[link.to_id]) for link in links]
        segments = places[np.array(ends)]
        origin = origin_near(segments.reshape(-1, 3))
        group = ctx.follow(None, offset=compose(sample.pose, Pose(origin)))
        colors = np.array([getattr(self, kind_of(link)) for link in links], np.uint8)
        both = np.repeat(colors[:, None], 2, axis=1)
        group.lines("links", segments - origin, both, ids=numbers, opacity=self.alpha)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a link: the poses that it connects, and what it comes from."""
        link = hit.sample.message.links[hit.id]
        kind = kind_of(link).replace("_", " ")
        return Details(f"Link {link.from_id} to {link.to_id}", {"Type": f"{link.type}, {kind}"})


def kind_of(link: Any) -> str:
    """Return the property with the colour of a link."""
    return KINDS[link.type if 0 <= link.type < len(KINDS) else 1]


def _is_known(id: int, rows: dict[int, int], is_good: NDArray[np.bool_]) -> bool:
    return id in rows and bool(is_good[rows[id]])
