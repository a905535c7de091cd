"""The PointCloud2 display, and what it shares with that of older clouds."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Context, Details, Hit, Input, Pose, Prop, Remedy, Rgb, Sample, Topic, compose
from webviz.api.nodes import POINTS_HELD, POINTS_PER_BLOCK
from webviz.data.words import joined, spaced
from webviz_displays.point_cloud2.cloud import Cloud, CloudError, drawable
from webviz_displays.point_cloud2.cloud_colors import (
    automatic,
    packed_colors,
    picked,
    separate_colors,
)
from webviz_displays.point_cloud2.decimation import Rows, evenly, one_per_voxel
from webviz_displays.shared.colors import layers
from webviz_displays.shared.points_display import BY_INTENSITY, DOTS_LIMIT, PointsDisplay
from webviz_displays.shared.properties import opaque

_BITS = 16
"""Number of bits of the number of a cell: numpy sorts numbers of 16 bits by radix, ten times as
fast."""

_SAMPLE = 10_000
"""Points from which the extent is estimated."""


def in_blocks(xyz: NDArray[np.float32]) -> Rows:
    """Return the rows of points (N, 3) in an order for `Points.thins`.

    The first `POINTS_PER_BLOCK` of them are from everywhere. Each further block has points that are
    near each other, shuffled: the first of them stand for all of it. Blocks follow each other at
    random, too, so that a cloud that is sent one after another becomes denser everywhere at once.

    Args:
        xyz: finite points, metres; at least one.
    """
    rng = np.random.default_rng(0)
    first = evenly(len(xyz), min(len(xyz), POINTS_PER_BLOCK))
    others = np.ones(len(xyz), np.bool_)
    others[first] = False
    rows = np.argsort(_cells(xyz), kind="stable")
    rows = rows[others[rows]]
    whole = len(rows) // POINTS_PER_BLOCK
    blocks = rows[: whole * POINTS_PER_BLOCK].reshape(whole, POINTS_PER_BLOCK)
    blocks = blocks[rng.permutation(whole)][:, rng.permutation(POINTS_PER_BLOCK)]
    rest = rng.permutation(rows[whole * POINTS_PER_BLOCK :])
    return np.concatenate((first, blocks.reshape(-1), rest))


def _cells(xyz: NDArray[np.float32]) -> NDArray[np.uint16]:
    """Return the number (N,) of the cell of each point.

    Cells with numbers near each other are neighbours.

    The box around most points is halved again and again across its longest side; each half is a
    bit. With equal sides this is the Morton order.
    """
    some = xyz[:: max(len(xyz) // _SAMPLE, 1)]
    low, high = np.percentile(some, (1, 99), axis=0)
    extent = np.maximum(high - low, 1e-6)
    steps = 1 << _BITS
    with np.errstate(over="ignore"):
        places = [
            np.clip((xyz[:, axis] - low[axis]) * (steps / extent[axis]), 0, steps - 1).astype(
                np.uint16
            )
            for axis in range(3)
        ]
    numbers = np.zeros(len(xyz), np.uint16)
    sides, halved = extent.copy(), [0, 0, 0]
    for bit in reversed(range(_BITS)):
        axis = int(np.argmax(sides))
        sides[axis] /= 2
        halved[axis] += 1
        numbers |= ((places[axis] >> (_BITS - halved[axis])) & 1) << bit
    return numbers


U8 = NDArray[np.uint8]
F32 = NDArray[np.float32]

AS_HELD = -1
"""A limit of as many points as browsers draw fast enough."""

REST_NS = 3_000_000_000
"""Time after the drawing of a cloud after which none is expected to follow; by then, browsers have
measured how many points they hold."""

WHITE = (255, 255, 255)
BY_FIELDS = Remedy("color_transformer", "Auto", "Choose by the fields")


class _State(msgspec.Struct):
    """The clouds that are drawn.

    Args:
        clouds: when each arrived, ROS time in nanoseconds, by number.
        shares: how many clouds share the limit of points.
        budget: limit of points by what browsers draw fast enough.
        newest: number of the cloud drawn last, None before the first.
        newest_arrival: that number and the time at which it was noticed, ROS time in nanoseconds.
        size: of that cloud, in points.
        resting: number of a cloud that no other follows, None if one does.
    """

    clouds: dict[int, int] = msgspec.field(default_factory=dict)
    shares: int = 1
    budget: int = POINTS_HELD
    newest: int | None = None
    newest_arrival: tuple[int | None, int] = (None, 0)
    size: int = 1 << 40
    resting: int | None = None


class CloudDisplay(PointsDisplay):
    """Base of displays of point clouds."""

    is_threaded = True

    color_transformer: Annotated[
        Literal["Auto", "Intensity", "AxisColor", "FlatColor", "RGB8", "RGBF32"],
        Prop(
            help="How points are coloured; Auto uses the first of rgb or rgba, intensity, "
            "r g b and the axis that the cloud has."
        ),
    ] = "Auto"
    channel_name: Annotated[
        str, Prop(when=BY_INTENSITY, help="Field that determines the colour.")
    ] = "intensity"
    max_points: Annotated[
        int,
        Prop(
            ge=AS_HELD,
            help="Limit of points shown, evenly sampled; 0 shows all. -1 shows as many as all "
            "browsers draw 20 times a second, and all of a cloud that no other follows. Clouds "
            "kept for the decay time share it. Each point takes 15 bytes to send.",
        ),
    ] = AS_HELD
    voxel_size: Annotated[
        float, Prop(ge=0, unit="m", help="Show one point of each cube of this size; 0 shows all.")
    ] = 0.0

    def cloud_of(self, message: Any) -> Cloud:
        """Return the points of a message.

        Raises:
            CloudError: they cannot be read.
        """
        raise NotImplementedError

    def new_state(self) -> _State:
        """No clouds."""
        return _State()

    def depends(self, ctx: Context) -> tuple[int, int, int | None]:
        """Return the number of clouds that share each limit of points, and the cloud shown whole.

        The number of clouds is a power of two, so that it seldom changes; the limit is 0 if it
        leaves out nothing.
        """
        state: _State = ctx.state
        now_ns, newest = ctx.frames.now_ns, state.newest
        if state.newest_arrival[0] != newest:
            state.newest_arrival = newest, now_ns
        is_at_rest = now_ns - state.newest_arrival[1] > REST_NS and not self.decay_time
        state.resting = newest if is_at_rest else None
        # A cloud at rest is sent once, whatever browsers hold later: they thin it by themselves.
        if state.resting is None:
            state.budget = ctx.share_of_points(state.size)
        oldest = now_ns - round(min(self.decay_time * 1e9, 2**63))
        # A copy, as `draw` may add a cloud in its thread.
        for number in [n for n, received_ns in state.clouds.copy().items() if received_ns < oldest]:
            del state.clouds[number]
        shares = state.shares if self.decay_time else 1
        count = len(state.clouds) + 1 if self.decay_time else 1  # including the next one
        if count > shares or count < shares // 4:
            shares = 1 << (count - 1).bit_length()
        state.shares = shares
        if self.max_points != AS_HELD or state.size * shares <= state.budget:
            return shares, 0, None
        return shares, state.budget, state.resting

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One cloud, in the frame of the sensor at the stamp."""
        state: _State = ctx.state
        state.clouds[sample.number] = sample.received_ns
        try:
            cloud = self.cloud_of(sample.message)
            xyz, origin = cloud.positions()
        except CloudError as error:
            ctx.error("Points", str(error))
            return
        if cloud.remark:
            ctx.warn("Data", cloud.remark)
        state.size = len(xyz)
        rows, thins, sentence = self._select(xyz, state, sample.number == state.resting)
        xyz = picked(xyz, rows)
        own = Pose(origin)
        fixed = compose(sample.pose, own) if any(origin) else sample.pose
        try:
            colors, opacities = self._colors(cloud, rows, xyz, own, fixed, ctx)
        except CloudError as error:
            text = joined(str(error), "The points are white.")
            # What the fields give by themselves, unless they are what is wrong.
            ctx.warn("Colors", text, None if self.color_transformer == "Auto" else BY_FIELDS)
            colors, opacities = WHITE, None
        if opacities is not None and opacities.min(initial=255) < 255:
            is_visible = opacities > 0
            xyz, rows = (
                xyz[is_visible],
                np.flatnonzero(is_visible) if rows is None else rows[is_visible],
            )
            colors, opacities = np.asarray(colors)[is_visible], opacities[is_visible]
            if hidden := len(is_visible) - len(xyz):
                sentence += f" {spaced(hidden)} of them are invisible: their rgba has alpha 0."
        state.newest = sample.number  # not before, as this may have taken seconds
        (ctx.ok if len(xyz) else ctx.warn)("Points", sentence)
        if self.alpha == 0:
            ctx.warn("Points", f"Invisible: alpha is 0. {sentence}", opaque())
            return
        group = ctx.follow(None, offset=fixed) if any(origin) else ctx
        # As in RViz, boxes turn with the sensor.
        if opacities is None or opacities.min(initial=255) == 255:
            self.draw_points(xyz, colors, group, ctx, ids=rows, thins=thins)
            return
        ids = np.arange(len(xyz)) if rows is None else rows
        for opacity, chosen in layers(opacities / 255.0):
            self.draw_points(
                xyz[chosen],
                np.asarray(colors)[chosen],
                group,
                ctx,
                ids=ids[chosen],
                opacity=opacity,
                of=len(xyz),
            )

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """All fields of a point."""
        cloud = self.cloud_of(hit.sample.message)
        fields = cloud.point(hit.id)
        position = {name: fields.pop(name) for name in "xyz" if name in fields}
        values = fields | {f"Position in {hit.sample.frame}": position}
        if cloud.width < cloud.count:
            values |= {"Row": hit.id // cloud.width, "Column": hit.id % cloud.width}
        return Details(f"Point {hit.id}", values | {"Points in the cloud": cloud.count})

    def _select(self, xyz: F32, state: _State, rests: bool) -> tuple[Rows | None, bool, str]:
        """Return the points to show.

        Args:
            xyz: all points of a cloud.
            state: says how many clouds share which limit.
            rests: whether no other cloud follows.

        Returns:
            Rows of points, None for all; whether browsers draw as many of them as they hold, in an
            order for `Points.thins`; and a sentence.
        """
        total, shares = len(xyz), state.shares
        if not total:
            empty = "The cloud is empty: width x height is 0. Check the sensor or its filter."
            return None, False, empty
        reasons: list[str] = []

        def left(before: int, rows: Rows | None, reason: str) -> int:
            after = before if rows is None else len(rows)
            if after < before:
                reasons.append(f"{spaced(before - after)} {reason}")
            return after

        rows = drawable(xyz)
        count = left(total, rows, "not finite or farther than 1e9 m")
        if self.voxel_size:
            selected_rows = one_per_voxel(picked(xyz, rows), self.voxel_size)
            rows = selected_rows if rows is None else rows[selected_rows]
            count = left(
                count, rows, f"in voxels of {self.voxel_size:g} m that already show a point"
            )
        name, limit = f"max_points of {spaced(self.max_points)}", self.max_points or count
        if limit == AS_HELD:
            limit = state.budget
            name = f"the {spaced(limit)} that browsers hold at 20 frames a second"
        if self.style == "Points" and limit > DOTS_LIMIT:
            name, limit = f"the limit of the style Points of {spaced(DOTS_LIMIT)}", DOTS_LIMIT
        thins = False
        most = max(limit // shares, 1)
        if count > most:
            thins = rests and self.max_points == AS_HELD and self.style != "Points"
            selected_rows = in_blocks(picked(xyz, rows)) if thins else evenly(count, most)
            rows = selected_rows if rows is None else rows[selected_rows]
            many = f" for {shares} clouds" if shares > 1 else ""
            count = left(count, rows, f"over {name}{many}")
        sentence = f"Showing {spaced(count)} of {spaced(total)} points"
        if reasons:
            sentence += f"; dropped: {', '.join(reasons)}"
        if thins:
            sentence += "; browsers thin out distant ones to keep 20 frames a second"
        return rows, thins, f"{sentence}."

    def _colors(
        self, cloud: Cloud, rows: Rows | None, xyz: F32, own: Pose, fixed: Pose, ctx: Context
    ) -> tuple[U8 | Rgb, U8 | None]:
        """Colours of points and, if the cloud has them, opacities from 0 to 255."""
        transformer = self.color_transformer
        if transformer == "Auto":
            transformer = automatic(cloud.names)
        match transformer:
            case "RGB8":
                colors, opacities = packed_colors(cloud, rows)
            case "RGBF32":
                colors, opacities = separate_colors(cloud, rows), None
            case "AxisColor":
                colors, opacities = self.axis_colors(xyz, own, fixed, ctx), None
            case "Intensity":
                values = picked(self._channel(cloud), rows)
                colors, opacities = self.intensity_colors(values, ctx), None
            case _:
                return self.color, None
        if self.color_transformer == "Auto":
            ctx.ok("Colors", f"{transformer}, by the fields: {cloud.fields}.")
        return colors, opacities

    def _channel(self, cloud: Cloud) -> NDArray[Any]:
        """Return the values (N,) that determine the colour.

        As in RViz "intensities" is a fallback.
        """
        name = self.channel_name
        if name == "intensity" and name not in cloud.names and "intensities" in cloud.names:
            name = "intensities"
        return cloud.values(name)


class PointCloud2(CloudDisplay):
    """Points of a 3D sensor or of a map."""

    rviz = "rviz_default_plugins/PointCloud2"
    icon = "cloud"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/PointCloud2"), Prop(help="Topic of the clouds.")
    ] = Topic("/points")

    def cloud_of(self, message: Any) -> Cloud:
        """Return the message as it is."""
        return Cloud(message)
