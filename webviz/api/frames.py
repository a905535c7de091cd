"""The transforms of one turn, for displays."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Pose
from webviz.data.rotations import w_first
from webviz.data.transforms import (
    Explanation,
    FramesIn,
    NewestTransform,
    Transform,
    TransformBuffer,
    TransformException,
    explain,
)
from webviz.data.transforms.geometry import REACH_M, is_within_reach
from webviz.data.transforms.geometry import compose as compose_tuples


@dataclass(frozen=True)
class FramePoses:
    """All frames in the fixed frame, each at its latest common time with it.

    Args:
        names: frame ids in order of first mention.
        positions: float64 (N, 3), metres.
        wxyzs: float64 (N, 4), unit quaternions.
        stamps_ns: int64 (N,), the latest common time; 0 where all transforms are static.
        ok: bool (N,), whether the pose can be drawn; other rows are invalid.
    """

    names: list[str]
    positions: NDArray[np.float64]
    wxyzs: NDArray[np.float64]
    stamps_ns: NDArray[np.int64]
    ok: NDArray[np.bool_]


class Frames:
    """Poses of frames in the fixed frame at one turn of the frame loop, each computed once.

    A frame whose transforms do not compose to a finite pose within `REACH_M` has none.

    Args:
        buffer: not to be changed while this object is in use.
        fixed_frame: frame id that everything is drawn in.
        now_ns: ROS time of the turn.
    """

    def __init__(self, buffer: TransformBuffer, fixed_frame: str, now_ns: int) -> None:
        self.buffer = buffer
        self.fixed_frame = fixed_frame
        self.now_ns = now_ns
        self._version = buffer.version
        self._poses: dict[tuple[str, int], Pose | None] = {}
        self._all: FramePoses | None = None
        self._is_all_wanted = False
        self._passed: dict[str, Pose] = {}

    @property
    def structure(self) -> object:
        """Changes whenever frames, their parents or static transforms do."""
        return self.buffer.structure_version

    def next(self, fixed_frame: str, now_ns: int) -> Frames:
        """Return the frames of the next turn, reusing poses that did not change."""
        frames = Frames(self.buffer, fixed_frame, now_ns)
        frames._is_all_wanted = self._is_all_wanted
        if fixed_frame == self.fixed_frame:
            frames._passed = self._passed
        if (frames._version, fixed_frame) == (self._version, self.fixed_frame):
            frames._all = self._all
            frames._poses = {key: pose for key, pose in self._poses.items() if key[1] == 0}
        return frames

    def prepare(self, names: Iterable[str]) -> None:
        """Compute the latest poses of many frames in one pass, before single look-ups."""
        missing = [name for name in names if (name, 0) not in self._poses]
        if not missing:
            return
        if self._is_all_wanted:  # in the previous turn
            self._is_all_wanted = False  # set again by `all`
            poses = self._compute_all()
            places = {name: place for place, name in enumerate(poses.names)}
            indices = [places[name] for name in missing if name in places]
            positions, wxyzs, ok = poses.positions[indices], poses.wxyzs[indices], poses.ok[indices]
            missing = [name for name in missing if name in places]
        else:
            some = self.buffer.poses_in(self.fixed_frame, missing)
            positions, wxyzs, ok = some.translations, w_first(some.rotations), _ok(some)
        rows = zip(missing, positions.tolist(), wxyzs.tolist(), ok.tolist(), strict=True)
        for name, position, wxyz, is_ok in rows:
            self._poses[name, 0] = Pose(tuple(position), tuple(wxyz)) if is_ok else None

    def pass_by(self) -> None:
        """Remember where all frames are, at a moment that a seek passes without drawing it."""
        poses = self._compute_all()
        rows = zip(
            poses.names, poses.positions.tolist(), poses.wxyzs.tolist(), poses.ok, strict=True
        )
        self._passed |= {name: Pose(tuple(at), tuple(wxyz)) for name, at, wxyz, ok in rows if ok}

    def passed(self, frame: str) -> Pose | None:
        """Return where a frame was when a seek passed it last, None if it passed none."""
        return self._passed.get(frame)

    def forget_passed(self) -> None:
        """Forget what seeks passed, such as before one to an earlier time."""
        self._passed.clear()

    def named(self, frame: str) -> str:
        """Return the name in the viewer of a frame that a message names."""
        return frame.removeprefix("/")

    def own(self, frame: str) -> str:
        """Return the name of a frame of the viewer for those who read messages of the display."""
        return frame

    def at(self, frame: str, stamp_ns: int) -> Pose | None:
        """Pose of a frame at a stamp (0: the latest common time), None if it is unknown."""
        key = (frame, stamp_ns)
        if key not in self._poses:
            try:
                pose = to_pose(self.buffer.lookup(self.fixed_frame, frame, stamp_ns))
                self._poses[key] = pose if is_placeable(pose) else None
            except TransformException:
                self._poses[key] = None
        return self._poses[key]

    def latest(self, frame: str) -> Pose | None:
        """Pose of a frame at its latest common time with the fixed frame."""
        return self.at(frame, 0)

    def now(self, frame: str) -> Pose | None:
        """Pose of a frame now, or at the latest common time if that is unknown yet."""
        return self.at(frame, self.now_ns) or self.at(frame, 0)

    def link(self, frame: str) -> NewestTransform | None:
        """Return the newest transform of a frame to its parent.

        None for roots and frames without data.
        """
        return self.buffer.link(frame)

    def along(
        self, frame: str, stamps_ns: NDArray[np.int64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
        """Poses of a frame at many stamps at once.

        Args:
            frame: frame id.
            stamps_ns: int64 (N,), in any order.

        Returns:
            Positions float64 (N, 3) in metres, unit quaternions float64 (N, 4) as (w, x, y, z),
            and bool (N,): whether the pose is known; other rows are NaN.
        """
        positions, rotations, ok = self.buffer.lookup_many(self.fixed_frame, frame, stamps_ns)
        return positions, w_first(rotations), ok

    def why_not(self, frame: str, stamp_ns: int = 0) -> str:
        """Return why a frame has no pose, with a remedy; one sentence."""
        return self.explain(frame, stamp_ns).sentence

    def explain(self, frame: str, stamp_ns: int = 0) -> Explanation:
        """Return why a frame has no pose, with a remedy."""
        return explain(self.buffer, self.fixed_frame, frame, stamp_ns, self.now_ns)

    def all(self) -> FramePoses:
        """All frames ever mentioned."""
        self._is_all_wanted = True
        return self._compute_all()

    def _compute_all(self) -> FramePoses:
        if self._all is None:
            poses = self.buffer.poses_in(self.fixed_frame)
            self._all = FramePoses(
                poses.frames,
                poses.translations,
                w_first(poses.rotations),
                poses.stamps_ns,
                _ok(poses),
            )
        return self._all


def to_pose(transform: Transform) -> Pose:
    """Return a transform as the pose of its source frame in its target frame."""
    x, y, z, w = transform.rotation
    return Pose(transform.translation, (w, x, y, z))


def is_placeable(pose: Pose) -> bool:
    """Return whether a pose is finite and within `REACH_M`, so that it can be drawn."""
    return is_within_reach(_flat(pose))


def compose(a: Pose, b: Pose) -> Pose:
    """Return the pose of `b`, given relative to `a`."""
    x, y, z, qx, qy, qz, qw = compose_tuples(_flat(a), _flat(b))
    return Pose((x, y, z), (qw, qx, qy, qz))


def _ok(poses: FramesIn) -> NDArray[np.bool_]:
    return poses.ok & (np.abs(poses.translations) <= REACH_M).all(axis=1)


def _flat(pose: Pose) -> tuple[float, float, float, float, float, float, float]:
    w, x, y, z = pose.wxyz
    return (*pose.position, x, y, z, w)
