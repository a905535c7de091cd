"""The clouds that RTAB-Map has collected."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import (
    Context,
    Details,
    Hit,
    Input,
    Keep,
    Pose,
    Prop,
    ProtocolClient,
    Remedy,
    Rgb,
    Sample,
    Topic,
    compose,
)
from webviz.api.connection import GraphConnection
from webviz.api.nodes import POINTS_HELD
from webviz.data.words import counted, joined
from webviz_displays.map_cloud.known_map import KnownMap
from webviz_displays.map_cloud.node_cloud import CloudSettings, NodeCloud
from webviz_displays.shared.geometry import transformed
from webviz_displays.shared.points_display import BY_INTENSITY, DOTS_LIMIT, PointsDisplay
from webviz_displays.shared.properties import opaque

__all__ = ["MapCloud"]

U8 = NDArray[np.uint8]

IDS = "std_msgs/msg/Int32MultiArray"
MAX_ASKED = 1000
"""Nodes asked for at once."""
AGAIN_S = 10.0
"""Time after which nodes are asked for once more."""

CloudMetres = Annotated[float, Prop(ge=0, le=999, unit="m")]
CloudHeight = Annotated[float, Prop(ge=-999, le=999, unit="m")]

BY_DATA = Remedy("color_transformer", "Auto", "Choose by the data")


class _State(msgspec.Struct):
    """The last drawing.

    Args:
        total: points of the clouds that it shows.
        budget: how many points browsers draw fast enough.
        requests: nodes of the newest graph that were asked for.
        again_s: when to ask for them once more, monotonic time in seconds.
        missing: nodes of the newest graph whose data never came.
        refused: why they cannot be asked for, "" if they can.
    """

    total: int = 0
    budget: int = POINTS_HELD
    requests: frozenset[int] = frozenset()
    again_s: float = 0.0
    missing: tuple[int, ...] = ()
    refused: str = ""


class MapCloud(PointsDisplay, ProtocolClient):
    """The clouds that RTAB-Map has collected, at the places that its graph gives them."""

    rviz = "rtabmap_rviz_plugins/MapCloud"
    is_threaded = True
    slow_bytes = 100_000  # to decode images takes far longer than to hand them over

    topic: Annotated[
        Topic, Input("rtabmap_msgs/msg/MapData"), Prop(help="Topic of the graphs and their data.")
    ] = Topic("/rtabmap/mapData")
    decay_time: Annotated[
        float,
        Prop(ge=0, unit="s", help="Show nodes up to this age before the newest; 0 shows all."),
    ] = 0.0
    color_transformer: Annotated[
        Literal["Auto", "RGB8", "Intensity", "AxisColor", "FlatColor"],
        Prop(help="How points are coloured; Auto is by images, or by the intensities of scans."),
    ] = "Auto"
    channel_name: Annotated[
        Literal["intensity", "x", "y", "z"],
        Prop(when=BY_INTENSITY, help="Value that determines the colour."),
    ] = "intensity"
    cloud_from_scan: Annotated[
        bool, Prop(rviz="Cloud from scan", help="Show laser scans instead of depth images.")
    ] = False
    cloud_decimation: Annotated[
        int,
        Prop(ge=1, le=16, rviz="Cloud decimation", help="Use each n-th row and column of depths."),
    ] = 4
    cloud_max_depth: Annotated[
        CloudMetres,
        Prop(rviz="Cloud max depth (m)", help="Maximum depth or range; 0 disables the limit."),
    ] = 4.0
    cloud_min_depth: Annotated[
        CloudMetres, Prop(rviz="Cloud min depth (m)", help="Smallest depth or range.")
    ] = 0.0
    cloud_voxel_size: Annotated[
        float,
        Prop(
            ge=0,
            le=1,
            unit="m",
            rviz="Cloud voxel size (m)",
            help="Keep one point of each cube of this size; 0 keeps all.",
        ),
    ] = 0.01
    filter_floor: Annotated[
        CloudHeight,
        Prop(
            rviz="Filter floor (m)", help="Remove points below this height; 0 disables the filter."
        ),
    ] = 0.0
    filter_ceiling: Annotated[
        CloudHeight,
        Prop(
            rviz="Filter ceiling (m)",
            help="Remove points above this height; 0 disables the filter.",
        ),
    ] = 0.0
    node_filtering_radius: Annotated[
        float,
        Prop(
            ge=0,
            le=10,
            unit="m",
            rviz="Node filtering radius (m)",
            help="Show only the newest of nodes that are this near and look the same way; 0 shows "
            "all.",
        ),
    ] = 0.0
    node_filtering_angle: Annotated[
        float,
        Prop(
            ge=0,
            le=359,
            unit="°",
            rviz="Node filtering angle (degrees)",
            help="Directions of nodes that differ by less count as equal; 0 shows all nodes.",
        ),
    ] = 30.0
    download_namespace: Annotated[
        str,
        Prop(
            rviz="Download namespace",
            help="Namespace of RTAB-Map, where data of older nodes is requested.",
        ),
    ] = "rtabmap"

    @property
    def uses(self) -> tuple[str, ...]:
        """The topic on which RTAB-Map is asked for data."""
        return (self._requests,)

    @property
    def _requests(self) -> str:
        return f"{self.download_namespace.rstrip('/')}/republish_node_data"

    def new_state(self) -> _State:
        """Nothing drawn."""
        return _State()

    def history(self) -> Keep:
        """Return the collected map."""
        return Keep()

    def fold(self, name: str, sample: Sample, state: KnownMap | None) -> KnownMap:
        """Take the graph, and the clouds of the nodes that came with it."""
        settings = CloudSettings(
            self.cloud_from_scan,
            self.cloud_decimation,
            self.cloud_min_depth,
            self.cloud_max_depth,
            self.cloud_voxel_size,
            self.filter_floor,
            self.filter_ceiling,
        )
        return (state or KnownMap()).merged(sample.message, settings)

    def communicate(self, connection: GraphConnection, ctx: Context) -> None:
        """Ask for the data of nodes that were published before the viewer listened."""
        state: _State = ctx.state
        try:
            state.refused = connection.advertise(self._requests, IDS, 1)
        except ValueError as error:
            state.refused = joined(str(error), "Correct Download Namespace.")
        missing = frozenset(state.missing[:MAX_ASKED])
        if missing - state.requests or (missing and connection.clock_s >= state.again_s):
            state.requests, state.again_s = missing, connection.clock_s + AGAIN_S
            if not state.refused:
                connection.publish(self._requests, {"data": sorted(missing)})

    def depends(self, ctx: Context) -> tuple[int, str]:
        """Return how many points browsers hold, and why no data can be asked for."""
        state: _State = ctx.state
        state.budget = ctx.share_of_points(state.total)
        return (state.budget if state.total > state.budget else 0), state.refused

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw the clouds, in the frame and at the stamp of the newest graph."""
        map_data: KnownMap = sample.message
        state: _State = ctx.state
        state.missing = tuple(map_data.missing)
        rows = self._rows(map_data)
        ids = map_data.ids[rows].tolist()
        state.total = sum(len(map_data.clouds[id].xyz) for id in ids)
        limit = min(state.budget, DOTS_LIMIT) if self.style == "Points" else state.budget
        # A power of two, so that a cloud changes seldom while the map grows.
        step = 1 << max(0, math.ceil(math.log2(max(state.total, 1) / max(limit, 1))))
        poses = [
            compose(sample.pose, Pose(tuple(position), tuple(wxyz)))
            for position, wxyz in zip(
                map_data.positions[rows].tolist(), map_data.wxyzs[rows].tolist(), strict=True
            )
        ]
        clouds = [map_data.clouds[id][::step] for id in ids]
        shown_ids = sum(len(cloud.xyz) for cloud in clouds)
        self._report(map_data, len(ids), shown_ids, state, ctx)
        if not shown_ids or self.alpha == 0:
            return
        ends = np.cumsum([len(cloud.xyz) for cloud in clouds])[:-1]
        colors = self._colors(clouds, poses, ctx)
        parts = [colors] * len(clouds) if isinstance(colors, tuple) else np.split(colors, ends)
        starts = _starts(map_data)
        for id, pose, cloud, own in zip(ids, poses, clouds, parts, strict=True):
            group = ctx.follow(None, offset=pose, key=str(id), is_rigid=True)
            numbers = starts[id] + step * np.arange(len(cloud.xyz))
            self.draw_points(cloud.xyz, own, group, ctx, ids=numbers, of=shown_ids)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a point: which node has seen it, and when."""
        map_data: KnownMap = hit.sample.message
        for id, start in _starts(map_data).items():
            cloud = map_data.clouds[id]
            if start <= hit.id < start + len(cloud.xyz):
                values: dict[str, object] = {
                    "Seen": f"{map_data.stamps[id]:.3f} s",
                    "Points of the node": len(cloud.xyz),
                }
                if cloud.intensities is not None:
                    values["Intensity"] = cloud.intensities[hit.id - start]
                return Details(f"Point of node {id}", values)
        return None

    def _rows(self, map_data: KnownMap) -> NDArray[np.intp]:
        """Return the nodes to show, as rows of the graph."""
        rows = map_data.apart(self.node_filtering_radius, math.radians(self.node_filtering_angle))
        rows = rows[[id in map_data.clouds for id in map_data.ids[rows].tolist()]]
        if self.decay_time and len(rows):
            stamps = np.array([map_data.stamps[id] for id in map_data.ids[rows].tolist()])
            rows = rows[stamps >= stamps.max() - self.decay_time]
        return rows

    def _colors(self, clouds: list[NodeCloud], poses: list[Pose], ctx: Context) -> U8 | Rgb:
        """Colours of the points of all clouds, so that equal values look the same in each."""
        colored = [cloud.colors for cloud in clouds if cloud.colors is not None]
        is_colored = len(colored) == len(clouds)
        transformer = self.color_transformer
        if transformer == "Auto":
            transformer = "RGB8" if is_colored else "Intensity"
            ctx.ok("Colors", f"{transformer}, chosen by the fields of the nodes.")
        xyz = np.concatenate([cloud.xyz for cloud in clouds])
        match transformer:
            case "RGB8" if is_colored:
                return np.concatenate(colored)
            case "AxisColor":
                fixed = xyz
                if self.use_fixed_frame:
                    both = zip(poses, clouds, strict=True)
                    fixed = np.concatenate([transformed(pose, each.xyz) for pose, each in both])
                return self.axis_colors(fixed, Pose(), Pose(), ctx)
            case "Intensity":
                if self.channel_name != "intensity":
                    return self.intensity_colors(xyz[:, "xyz".index(self.channel_name)], ctx)
                if colored and not self.cloud_from_scan:
                    ctx.warn("Colors", "Depth images have no intensities. Choose RGB8.", BY_DATA)
                values = [_intensities(cloud) for cloud in clouds]
                return self.intensity_colors(np.concatenate(values), ctx)
            case "FlatColor":
                return self.color
            case _:
                text = "Scans have no colours. The points are white; choose Intensity."
                ctx.warn("Colors", text, BY_DATA)
                return 255, 255, 255

    def _report(
        self, map_data: KnownMap, nodes: int, points: int, state: _State, ctx: Context
    ) -> None:
        count = f"{counted(points, 'point')} of {counted(nodes, 'node')}"
        thinned = f", one of {round(state.total / points)}" if points < state.total else ""
        if map_data.faults:
            id, why = next(iter(map_data.faults.items()))
            more = f", and {len(map_data.faults) - 1} more" if len(map_data.faults) > 1 else ""
            ctx.warn("Nodes", f"Node {id} is left out{more}: {why}.")
        elif map_data.dropped:
            text = f"{counted(map_data.dropped, 'node')} left out: the map has too many points."
            ctx.warn("Nodes", f"{text} Increase Cloud Decimation or Cloud Voxel Size.")
        elif state.missing and state.refused:
            waits = f"{counted(len(state.missing), 'node')} without data."
            ctx.warn("Nodes", f"{waits} {state.refused}")
        elif state.missing:
            topic = self._requests
            ctx.ok("Nodes", f"{counted(len(state.missing), 'node')} asked for on {topic}.")
        if map_data.problem:
            ctx.error("Points", joined(map_data.problem, "Fix the publisher."))
        elif not points and map_data.received and not map_data.clouds and not map_data.faults:
            sorts = ["depth images", "laser scans"]
            text = f"The nodes have no {sorts[self.cloud_from_scan]}. Change Cloud from scan."
            other = not self.cloud_from_scan
            ctx.warn("Points", text, Remedy("cloud_from_scan", other, f"Show {sorts[other]}"))
        elif not points:
            ctx.warn("Points", f"{count}: nothing to draw.")
        elif self.alpha == 0:
            ctx.warn("Points", "Invisible: alpha is 0. Increase it to show the points.", opaque())
        else:
            ctx.ok("Points", f"{count}{thinned}.")


def _starts(map_data: KnownMap) -> dict[int, int]:
    """Return the number of the first point of each node, among those of all."""
    starts: dict[int, int] = {}
    count = 0
    for id, cloud in map_data.clouds.items():
        starts[id] = count
        count += len(cloud.xyz)
    return starts


def _intensities(cloud: NodeCloud) -> NDArray[Any]:
    if cloud.intensities is not None:
        return cloud.intensities
    return np.zeros(len(cloud.xyz), np.float32)
