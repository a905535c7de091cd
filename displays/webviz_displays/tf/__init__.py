"""The tree of coordinate frames."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import Annotated

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import (
    Context,
    Details,
    Display,
    FramePoses,
    Frames,
    Group,
    Hit,
    OtherFixedFrame,
    Pose,
    Prop,
    Remedy,
    Sample,
    Status,
)
from webviz.api.frames import to_pose
from webviz.data.rotations import to_rpy
from webviz.data.transforms import Explanation, distinct, receptions
from webviz_displays.shared.geometry import origin_near
from webviz_displays.tf.frame_filter import (
    FrameFilter,
    Pattern,
    PatternFault,
    compiled,
    parent_indices,
)
from webviz_displays.tf.frame_marks import Ages, Marks, add_arrows, add_axes, add_names, fade

__all__ = ["TF"]

LISTED = 40
"""Frames listed by name; the rest is counted."""


def outline(names: Sequence[str], parents: NDArray[np.int64]) -> str:
    """Each frame with its children in parentheses, such as `map (odom (base (laser, wheel)))`.

    A loop, which has no root, begins with one of its frames: `a (b (c (a, again)))`.

    Args:
        names: frame ids.
        parents: int64 (N,), place in `names` of each frame's parent, -1 for roots.
    """
    children: dict[int, list[int]] = {}
    for place, parent in enumerate(parents.tolist()):
        children.setdefault(parent, []).append(place)
    for places in children.values():
        places.sort(key=lambda place: names[place])
    text, listed = "", set[int]()
    # Not recursive: a chain of frames may be longer than Python's stack.
    by_name = sorted(range(len(names)), key=lambda place: names[place])
    pending = [iter([*children.get(-1, ()), *by_name])]
    while pending:
        place = next(pending[-1], None)
        if place is None or len(listed) == LISTED:
            pending.pop()
            text += ")" if pending else ""
            continue
        if place in listed:
            text += f"{names[place]}, again" if len(pending) > 1 else ""
            continue
        text += ("" if not text or text.endswith(" (") else ", ") + names[place]
        listed.add(place)
        if place in children:
            text += " ("
            pending.append(iter(children[place]))
    text = text.replace(" ()", "")
    rest = len(names) - len(listed)
    return text + (f" and {rest} more" if rest else "")


SECOND = 1_000_000_000

NAMED = 5
"""Lost frames that get a status of their own."""

READ_OUT = 20
"""Frames whose pose is reported."""


class _FrameSelection(msgspec.Struct, eq=False):
    """State derived from the names and the shape of the tree."""

    version: tuple[object, int]
    selected: NDArray[np.bool_]
    parents: NDArray[np.int64]
    order: NDArray[np.int64]
    tree: str


class _Tick(msgspec.Struct, frozen=True):
    """Nodes and statuses of one tick, reused by ticks that draw nothing new."""

    now_ns: int
    groups: dict[str, Group]
    statuses: dict[str, Status]


class _State(msgspec.Struct):
    """State derived from properties, names and time.

    Args:
        fixed_frame: in which `ages` were measured.
        ages: of frames.
        filter: by the properties.
        selection: by names and the shape of the tree.
        last: the tick that was drawn last.
        reasons: why frames are lost.
        reasons_of: which frames, and at which second that was asked.
    """

    fixed_frame: str = ""
    ages: Ages = msgspec.field(default_factory=Ages)
    filter: FrameFilter = msgspec.field(default_factory=lambda: FrameFilter(None, None, {}, True))
    selection: _FrameSelection | None = None
    last: _Tick | None = None
    reasons: dict[str, Explanation] = msgspec.field(default_factory=dict)
    reasons_of: tuple[bytes, int] | None = None


class TF(Display):
    """The coordinate frames, their names, and arrows to their parents."""

    rviz = "rviz_default_plugins/TF"
    icon = "tree"

    show_names: Annotated[bool, Prop(help="Write each frame's name below its origin.")] = False
    show_axes: Annotated[bool, Prop(help="Draw each frame's axes: x red, y green, z blue.")] = True
    show_arrows: Annotated[bool, Prop(help="Draw an arrow from each frame to its parent.")] = True
    marker_scale: Annotated[
        float, Prop(gt=0, help="Size of names, axes and arrows; at 1 an axis is 0.2 m long.")
    ] = 1.0
    update_interval: Annotated[
        float,
        Prop(ge=0, unit="s", help="Minimum time between updates; 0 updates as often as possible."),
    ] = 0.0
    frame_timeout: Annotated[
        float,
        Prop(
            ge=1,
            unit="s",
            help="Frames not updated for one third of this time turn grey, then disappear.",
        ),
    ] = 15.0
    filter_whitelist: Annotated[
        str,
        Prop(
            rviz="Filter (whitelist)",
            help="Show only frames whose name matches this regular expression.",
        ),
    ] = ""
    filter_blacklist: Annotated[
        str,
        Prop(
            rviz="Filter (blacklist)",
            help="Hide frames whose name matches this regular expression.",
        ),
    ] = ""
    all_enabled: Annotated[
        bool, Prop(rviz="Frames/All Enabled", help="Show frames that have no switch of their own.")
    ] = True
    frames: Annotated[
        dict[str, bool],
        Prop(
            widget="frame",
            otherwise="all_enabled",
            help="Switches of single frames by name; frames switched on report their pose.",
        ),
    ] = msgspec.field(default_factory=dict)

    def new_state(self) -> _State:
        """Nothing known."""
        return _State()

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Properties or the fixed frame changed: derive everything anew."""
        whitelist = _pattern("whitelist", self.filter_whitelist, ctx)
        blacklist = _pattern("blacklist", self.filter_blacklist, ctx)
        state: _State = ctx.state
        if state.fixed_frame != ctx.frames.fixed_frame:
            state.fixed_frame, state.ages = ctx.frames.fixed_frame, Ages()
        state.filter = FrameFilter(whitelist, blacklist, self.frames, self.all_enabled)
        state.selection = state.last = state.reasons_of = None

    def tick(self, ctx: Context) -> None:
        """Draw every frame where it is at the latest common time with the fixed frame."""
        state: _State = ctx.state
        now_ns = ctx.frames.now_ns
        if (last := state.last) and now_ns - last.now_ns < self.update_interval * SECOND:
            ctx.groups.update(last.groups)
            ctx.statuses.update(last.statuses)
            return
        poses = ctx.frames.all()
        if not poses.names:
            recorded = ctx.frames.buffer.recorded
            text = "No transforms received on /tf or /tf_static. Start robot_state_publisher."
            ctx.warn("Frames", f"No transforms yet: {recorded}." if recorded else text)
            return
        selection = self._selection(ctx, poses.names)
        ages = state.ages.update(poses.stamps_ns, now_ns, partial(receptions, ctx.frames.buffer))
        is_young = ages <= self.frame_timeout
        is_shown = selection.selected & poses.ok & is_young
        # By name, as the order in which frames came depends on when the subscription began.
        self._draw(selection.order[is_shown[selection.order]], poses, selection.parents, ages, ctx)
        self._report(selection.selected, is_shown, poses, ctx)
        ctx.ok("Tree", f"{selection.tree}.")
        groups = dict(ctx.groups)
        state.last = _Tick(now_ns, groups, dict(ctx.statuses))

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a frame: its parent, its pose and how old that is."""
        return details(ctx.frames, hit.id)

    def _selection(self, ctx: Context, names: list[str]) -> _FrameSelection:
        state: _State = ctx.state
        version = (ctx.frames.structure, len(names))
        if state.selection is None or state.selection.version != version:
            selected = state.filter.select(names)
            parents = parent_indices(ctx.frames, names)
            # As objects, or each name would take the memory of the longest one.
            order = np.argsort(np.array(names, object))
            state.selection = _FrameSelection(
                version, selected, parents, order, outline(names, parents)
            )
        return state.selection

    def _draw(
        self,
        rows: NDArray[np.int64],
        poses: FramePoses,
        parents: NDArray[np.int64],
        ages: NDArray[np.float64],
        ctx: Context,
    ) -> None:
        if not len(rows):
            return
        near = origin_near([poses.positions[rows].mean(axis=0)])
        group = ctx.follow(None, offset=Pose(near), key="near")
        greyness, opacity = fade(ages[rows], self.frame_timeout)
        scale = self.marker_scale
        names = np.array(poses.names, object)[rows]
        marks = Marks(poses.positions[rows] - near, greyness, opacity, names)
        if self.show_axes:
            add_axes(group, marks, poses.wxyzs[rows], scale)
        if self.show_arrows:
            has_parent = (parents[rows] >= 0) & poses.ok[parents[rows]]
            tips = poses.positions[parents[rows]] - near
            add_arrows(group, marks.only(has_parent), tips[has_parent], scale)
        if self.show_names:
            add_names(group, marks, scale)

    def _report(
        self,
        selected: NDArray[np.bool_],
        visible: NDArray[np.bool_],
        poses: FramePoses,
        ctx: Context,
    ) -> None:
        unplaced = np.flatnonzero(selected & ~poses.ok)
        count, total, selected_count = int(visible.sum()), len(poses.names), int(selected.sum())
        old = selected_count - count - len(unplaced)
        parts = [f"{count} of {total} frames shown" if count < total else f"{count} frames shown"]
        if selected_count < total:
            parts.append(f"{total - selected_count} switched off or filtered out")
        if len(unplaced):
            parts.append(f"{len(unplaced)} have no transform to '{ctx.frames.fixed_frame}'")
        if old:
            parts.append(f"{old} not updated for more than {self.frame_timeout:g} s")
        is_off = not count and not self.all_enabled
        remedy = Remedy("all_enabled", True, "Show all frames") if is_off else None
        text = f"{', '.join(parts)}."
        if count and not old and not len(unplaced):
            ctx.ok("Frames", text)
        else:
            ctx.warn("Frames", text, remedy)
        # Explanations contain times, so they are renewed, but not on every tick.
        moment = (unplaced.tobytes(), ctx.frames.now_ns // SECOND)
        state: _State = ctx.state
        if state.reasons_of != moment:
            names = sorted(poses.names[place] for place in unplaced)
            state.reasons_of = moment
            state.reasons = distinct(names, ctx.frames.explain, NAMED)
        for name, reason in state.reasons.items():
            ctx.warn(name, reason.sentence, OtherFixedFrame.of(reason), reason)
        for name in [name for name, is_on in self.frames.items() if is_on][:READ_OUT]:
            if name not in ctx.statuses and (text := readout(ctx.frames, name)):
                ctx.ok(name, text)


def _pattern(which: str, text: str, ctx: Context) -> Pattern | None:
    """Return the regular expression of a filter, None if it is empty or invalid."""
    try:
        return compiled(text) if text else None
    except PatternFault as error:
        problem = f"'{text}' is not a valid regular expression ({error}); ignoring it."
        ctx.error(f"Filter ({which})", problem, Remedy(f"filter_{which}", "", "Clear the filter"))
        return None


def readout(frames: Frames, name: str) -> str | None:
    """Return the newest pose of a frame in its parent and in the fixed frame, None if unknown.

    Angles are roll, pitch and yaw about the parent's axes (URDF's order), in degrees.
    """
    if (link := frames.link(name)) is None:
        return None
    kind = "static" if link.is_static else "moving"
    text = f"In '{link.parent}' ({kind}): {_words(to_pose(link.transform))}."
    pose = frames.latest(name)
    if pose is None or link.parent == frames.fixed_frame:
        return text
    return f"{text} In '{frames.fixed_frame}': {_words(pose)}."


def details(frames: Frames, name: str) -> Details | None:
    """Return the current details of a frame, None if it is unknown."""
    link, pose = frames.link(name), frames.latest(name)
    if link is None and pose is None:
        return None
    values: dict[str, object] = {"Parent": "none: it is a root" if link is None else link.parent}
    if link is not None:
        age_s = (frames.now_ns - link.transform.stamp_ns) / 1e9
        values["Age"] = "static" if link.is_static else f"{age_s:.2f} s"
        values[f"Pose in {link.parent}"] = to_pose(link.transform)
    if pose is not None and (link is None or link.parent != frames.fixed_frame):
        values[f"Pose in {frames.fixed_frame}"] = pose
    return Details(f"Frame {name}", values)


def _words(pose: Pose) -> str:
    x, y, z = pose.position
    roll, pitch, yaw = map(math.degrees, to_rpy(pose.wxyz))
    return (
        f"position ({x:.3f}, {y:.3f}, {z:.3f}) m, "
        f"roll, pitch and yaw ({roll:.1f}, {pitch:.1f}, {yaw:.1f}) degrees"
    )
