"""A static frame in another pose: where would its data be if it were mounted like that?"""

from __future__ import annotations

import math
import shlex
from collections.abc import Mapping, Sequence
from xml.sax.saxutils import quoteattr

from webviz.api.errors import Error
from webviz.api.frames import compose, is_placeable, to_pose
from webviz.api.nodes import Pose
from webviz.api.roles import Role
from webviz.data.rotations import conjugate, from_rpy, to_rpy, w_last
from webviz.data.transforms import TransformException
from webviz.data.transforms.buffer import TransformBuffer
from webviz.data.transforms.cache import ParentedPose, StaticCache
from webviz.data.transforms.geometry import PoseTuple
from webviz.data.transforms.tree import ancestors
from webviz.engine.commands import Sender
from webviz.engine.feature import Feature, command, store
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import PartContext
from webviz.engine.pipeline import Runner
from webviz.engine.store import PageStore
from webviz.features.what_if.frame_handle import FrameHandle, FrameTrial


class PinnedCache(StaticCache):
    """A cache that answers with a pose of its own, and keeps what is published meanwhile.

    Args:
        published: the cache it stands in for.
    """

    __slots__ = ("published",)

    def __init__(self, published: StaticCache) -> None:
        super().__init__()
        self.sample = published.sample
        self.published = published

    def insert(self, stamp_ns: int, sample: ParentedPose) -> bool:
        """Keep what is published; the pinned pose stays."""
        return self.published.insert(stamp_ns, sample)


def pin(buffer: TransformBuffer, frame: str, pose: PoseTuple) -> bool:
    """Replace the pose of a static frame in its parent until `unpin`, whatever is published.

    Args:
        buffer: has the frame.
        frame: id of the frame.
        pose: in its parent, with a unit quaternion.

    Returns:
        Whether it is done; only static frames can be pinned.
    """
    cache = buffer.tree.caches.get(frame)
    if not isinstance(cache, StaticCache) or (parent := cache.parent) is None:
        return False
    if not isinstance(cache, PinnedCache):
        cache = buffer.tree.caches[frame] = PinnedCache(cache)
    cache.sample = pose, parent
    _note(buffer)
    return True


def unpin(buffer: TransformBuffer, frame: str) -> None:
    """Return to what is published about a frame; nothing happens if it is not pinned."""
    cache = buffer.tree.caches.get(frame)
    if isinstance(cache, PinnedCache):
        buffer.tree.caches[frame] = cache.published
        _note(buffer)


def is_pinned(buffer: TransformBuffer, frame: str) -> bool:
    """Return whether a frame is pinned; not any more if it became a moving one."""
    return isinstance(buffer.tree.caches.get(frame), PinnedCache)


def _note(buffer: TransformBuffer) -> None:
    """Let all that was computed from the static pose be computed again."""
    buffer.version += 1
    buffer.structure_version += 1


ID = "whatif"
"""Id of the display with the handle."""
NO_SCAN = (
    "Not found: no laser scan of this frame is compared with a map. Add displays of both, and wait "
    "until they are drawn."
)

NO_TRIAL = "No frame is being tried. Choose one in the panel TF."


class WhatIfStore(PageStore, frozen=True):
    """The frame that is tried in another pose; no field without one.

    Args:
        frame, parent: ids.
        pose: of the frame in its parent: x, y, z in metres, and roll, pitch, yaw in radians.
        fits: how well each scan of the frame lies on walls, and did before, sentences.
        urdf: the origin of its joint in a URDF.
        command: publishes it as a static transform.
        browser: that tries it, None for a program.
    """

    frame: str
    parent: str
    pose: Sequence[float]
    fits: Sequence[str]
    urdf: str
    command: str
    browser: int | None


class WhatIfFeature(Feature):
    """Tries one static frame at a time in another pose, for this viewer alone."""

    name = "What if"
    module = "what_if.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._trial: FrameTrial | None = None
        self._browser: int | None = None
        self._shares: Mapping[str, float] = {}
        """Shares of points on walls before the trial, by the ids of displays."""

    @property
    def _displays(self) -> DisplaysPart:
        return self.context.get(DisplaysPart)

    def keep_up(self, commanded: bool) -> None:
        """End when the frame is not a static one any more."""
        trial = self._trial
        if trial and not is_pinned(self.context.buffer, trial.frame):
            self._leave()

    @store()
    def what_if(self, argument: str) -> WhatIfStore | None:
        """Return the trial, and how well scans fit."""
        trial = self._trial
        if trial is None:
            return None
        names = {
            runner.id: runner.display.name or type(runner.display).__name__
            for runner in self._displays.list.active()
        }
        return WhatIfStore(
            frame=trial.frame,
            parent=trial.parent,
            pose=[*trial.pose.position, *to_rpy(trial.pose.wxyz)],
            fits=[
                f"{names[id]}: {fit.fit.share:.0%} of {fit.fit.points} points on walls of "
                f"{fit.map_topic}{self._before(id)}"
                for id, fit in self._displays.consistency.fits.items()
                if id in names and self._carries(fit.frame)
            ],
            urdf=urdf_origin(trial.pose),
            command=static_transform_publisher(trial.parent, trial.frame, trial.pose),
            browser=self._browser,
        )

    def close(self) -> None:
        """End the trial."""
        self._leave()

    def _before(self, display: str) -> str:
        share = self._shares.get(display)
        return "" if share is None else f" ({share:.0%} before)"

    @command(Role.OPERATOR)
    def try_frame(self, frame: str, sender: Sender, yaw: float = 0.0) -> None:
        """Take hold of a static frame; another one that is tried returns to its place.

        Args:
            frame: its id.
            yaw: by which it is turned about its own z axis at first, in radians.
        """
        if not math.isfinite(yaw):
            raise Error("The yaw is not a number. Give it in radians.")
        self._leave()
        buffer = self.context.buffer
        link = buffer.link(frame)
        if link is None or not link.is_static:
            raise Error(f"'{frame}' does not have a static transform. Choose one that has.")
        pose = to_pose(link.transform)
        if not is_placeable(pose):
            raise Error(f"'{frame}' is too far away, or its pose is not finite.")
        trial = FrameTrial(frame, link.parent, pose, pose, self._move)
        self._trial, self._browser = trial, sender.browser
        self._shares = {id: fit.fit.share for id, fit in self._displays.consistency.fits.items()}
        self._move(compose(pose, Pose(wxyz=from_rpy(0.0, 0.0, yaw))) if yaw else pose)
        self._displays.list.aids[:] = [
            Runner(ID, FrameHandle(trial=trial), self._displays.services)
        ]

    @command(Role.OPERATOR)
    def move_frame(
        self, x: float, y: float, z: float, roll: float, pitch: float, yaw: float
    ) -> None:
        """Place the tried frame in its parent.

        Args:
            x, y, z: in metres.
            roll, pitch, yaw: about the fixed axes x, y and z, in radians.
        """
        if self._trial is None:
            raise Error(NO_TRIAL)
        pose = Pose((x, y, z), wxyz=from_rpy(roll, pitch, yaw))
        if not is_placeable(pose):
            raise Error("Not moved: too far away, or not finite. Give metres and radians.")
        self._move(pose)

    def _move(self, pose: Pose) -> None:
        trial = self._trial
        if trial is None or not is_placeable(pose):
            return
        x, y, z, w = w_last(pose.wxyz)
        pin(self.context.buffer, trial.frame, (*pose.position, x, y, z, w))
        trial.pose = pose
        trial.version += 1
        self._displays.consistency.hurry()

    @command(Role.OPERATOR)
    def find_frame(self) -> None:
        """Move the tried frame to where its laser scan fits the map best."""
        trial = self._trial
        if trial is None:
            raise Error(NO_TRIAL)
        buffer = self.context.buffer
        below = {frame for frame in buffer.frames() if self._carries(frame)}
        aligned = self._displays.consistency.aligned(below)
        if aligned is None:
            raise Error(NO_SCAN)
        try:
            parent = to_pose(buffer.lookup(aligned.map_frame, trial.parent, aligned.stamp_ns))
        except TransformException as error:
            raise Error(NO_SCAN) from error
        # The correction in the map, applied to the tried frame as a whole.
        on_map = compose(parent, trial.pose)
        moved = compose(compose(aligned.after, _inverse(aligned.before)), on_map)
        self._move(compose(_inverse(parent), moved))

    @command(Role.OPERATOR)
    def end_trial(self) -> None:
        """Return the tried frame to where its transforms have it."""
        self._leave()

    def _leave(self) -> None:
        trial, self._trial = self._trial, None
        if trial is None:
            return
        unpin(self.context.buffer, trial.frame)
        for runner in self._displays.list.aids:
            runner.close()
        self._displays.list.aids.clear()
        self._displays.consistency.hurry()

    def _carries(self, frame: str) -> bool:
        """Return whether a frame moves with the one that is tried."""
        trial = self._trial
        return trial is not None and trial.frame in ancestors(self.context.buffer.tree, frame)


def _inverse(pose: Pose) -> Pose:
    w, x, y, z = conjugate(pose.wxyz).tolist()
    px, py, pz = pose.position
    return compose(Pose(wxyz=(w, x, y, z)), Pose((-px, -py, -pz)))


def urdf_origin(pose: Pose) -> str:
    """Return the origin of a joint with a pose, for a URDF or xacro file."""
    values = pose.position, to_rpy(pose.wxyz)
    xyz, rpy = (quoteattr(" ".join(map(_text, each))) for each in values)
    return f"<origin xyz={xyz} rpy={rpy}/>"


def static_transform_publisher(parent: str, frame: str, pose: Pose) -> str:
    """Return the command that publishes the pose of a frame in its parent."""
    names = "x", "y", "z", "roll", "pitch", "yaw"
    values = zip(names, (*pose.position, *to_rpy(pose.wxyz)), strict=True)
    numbers = " ".join(f"--{name} {_text(value)}" for name, value in values)
    frames = f"--frame-id {shlex.quote(parent)} --child-frame-id {shlex.quote(frame)}"
    return f"ros2 run tf2_ros static_transform_publisher {numbers} {frames}"


def _text(value: float) -> str:
    """Return a value to a tenth of a millimetre or milliradian, without a negative zero."""
    return f"{round(value, 4) + 0.0:g}"
