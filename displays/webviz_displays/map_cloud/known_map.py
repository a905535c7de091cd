"""RTAB-Map's graph and the clouds of its nodes, collected from messages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.images import ImageError
from webviz.data.messages import PoseSequence
from webviz.data.rotations import normalized, w_first
from webviz_displays.map_cloud.node_cloud import CloudSettings, NodeCloud, cloud_of
from webviz_displays.shared.geometry import is_drawable

F64 = NDArray[np.float64]

MAX_POINTS = 6_000_000
"""Points that are held; 90 MB."""
MAX_NODES = 10_000
"""Poses and nodes that are held."""


class KnownMap(msgspec.Struct, frozen=True, eq=False):
    """All nodes that are known.

    Args:
        ids: (N,), of the poses of the newest graph; those of landmarks are negative.
        positions: (N, 3), metres in the frame of the map.
        wxyzs: (N, 4).
        clouds: by the id of their node.
        stamps: of these nodes in seconds, by id.
        faults: why nodes have no cloud, by id.
        received: ids of the nodes whose data came.
        points: of all clouds.
        dropped: nodes whose clouds are left out because there are too many points.
        problem: why the newest graph cannot be read, "" if it can.
    """

    ids: NDArray[np.int64] = msgspec.field(default_factory=lambda: np.empty(0, np.int64))
    positions: F64 = msgspec.field(default_factory=lambda: np.empty((0, 3)))
    wxyzs: F64 = msgspec.field(default_factory=lambda: np.empty((0, 4)))
    clouds: Mapping[int, NodeCloud] = msgspec.field(default_factory=dict)
    stamps: Mapping[int, float] = msgspec.field(default_factory=dict)
    faults: Mapping[int, str] = msgspec.field(default_factory=dict)
    received: frozenset[int] = frozenset()
    points: int = 0
    dropped: int = 0
    problem: str = ""

    def merged(self, message: Any, settings: CloudSettings) -> KnownMap:
        """Return the map after an rtabmap_msgs/msg/MapData."""
        ids = np.array(message.graph.poses_id[:MAX_NODES], np.int64)
        poses: PoseSequence = message.graph.poses
        problem = ""
        if len(poses) != len(message.graph.poses_id):
            problem = f"{len(poses)} poses for {len(message.graph.poses_id)} ids."
            ids = ids[:0]
        positions = poses.positions[: len(ids)]
        wxyzs, _ = normalized(w_first(poses.orientations[: len(ids)]))
        ok = is_drawable(positions) & np.isfinite(poses.orientations[: len(ids)]).all(axis=1)
        clouds, stamps, faults = dict(self.clouds), dict(self.stamps), dict(self.faults)
        points, dropped = self.points, self.dropped
        nodes: Sequence[Any] = message.nodes[:MAX_NODES]
        for node in nodes:
            faults.pop(node.id, None)
            try:
                cloud = cloud_of(node, settings)
            except ImageError as error:
                faults[node.id] = str(error).removesuffix(".")
                continue
            if cloud is None:
                continue
            if (before := clouds.pop(node.id, None)) is not None:
                points -= len(before.xyz)
            if points + len(cloud.xyz) > MAX_POINTS or len(clouds) >= MAX_NODES:
                dropped += 1
                continue
            clouds[node.id] = cloud
            stamps[node.id] = float(node.stamp)
            points += len(cloud.xyz)
        received = self.received | {int(node.id) for node in nodes}
        if len(received) > MAX_NODES:
            received = received & set(ids.tolist())
        return KnownMap(
            ids[ok],
            positions[ok],
            wxyzs[ok],
            clouds,
            stamps,
            dict(list(faults.items())[-MAX_NODES:]),
            received,
            points,
            dropped,
            problem,
        )

    @property
    def missing(self) -> list[int]:
        """Nodes of the graph whose data never came."""
        return [id for id in self.ids.tolist() if id > 0 and id not in self.received]

    def apart(self, radius_m: float, angle: float) -> NDArray[np.intp]:
        """Rows of the poses of which none is near a newer one.

        Args:
            radius_m: within which a pose is near; 0 keeps all.
            angle: in radians, up to which two poses look the same way; 0 keeps all.
        """
        if not radius_m or not angle:
            return np.arange(len(self.ids))
        chosen: list[int] = []
        closest = np.cos(angle / 2)
        for row in np.argsort(-self.ids, kind="stable").tolist():
            away = np.linalg.norm(self.positions[chosen] - self.positions[row], axis=1)
            turned = np.abs(self.wxyzs[chosen] @ self.wxyzs[row])
            if not ((away <= radius_m) & (turned >= closest)).any():
                chosen.append(row)
        return np.array(sorted(chosen), np.intp)
