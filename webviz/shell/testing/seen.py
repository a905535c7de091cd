"""The visible nodes and the statuses of a viewer under test."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import (
    Arrows,
    Axes,
    Image,
    Instances,
    Labels,
    Lines,
    Mesh,
    Node,
    Points,
    Pose,
    has_content,
)
from webviz.api.status import Status
from webviz.data.rotations import matrices
from webviz.engine.state import Row, State
from webviz.files import config as config_file
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.watched import WatchedViewer

__tracebackhide__ = True  # failures are shown where the test calls

F64 = NDArray[np.float64]
N = TypeVar("N")
Vector = tuple[float, float, float]


class Seen:
    """The content of a viewer by display.

    Displays are given by name; None is the first in the list. Positions are in metres in the fixed
    frame.

    Args:
        viewer: draws in `scene`.
        scene: of the viewer.
    """

    def __init__(self, viewer: WatchedViewer, scene: RecordingScene) -> None:
        self.viewer = viewer
        self.scene = scene

    # Statuses

    def state(self) -> State:
        """Return the state for panels."""
        return self.viewer.snapshot()

    def statuses(self, display: str | None = None) -> Mapping[str, Status]:
        """All statuses of a display by key."""
        return self._row(display).statuses

    def status(self, display: str | None = None) -> Status:
        """Return the worst level of a display, with the texts of all statuses of that level."""
        row = self._row(display)
        texts = [f"{key}: {s.text}" for key, s in row.statuses.items() if s.level is row.level]
        return Status(row.level, "\n".join(texts))

    # Nodes

    def nodes(self, display: str | None = None) -> dict[str, tuple[Pose, Node]]:
        """All visible nodes of a display with their poses in the fixed frame, by key."""
        with self.scene.lock:
            seen = self.scene.visible(self._prefix(display))
            return {key: (pose, node) for key, pose, node in seen}

    def points(self, display: str | None = None) -> F64:
        """Positions (N, 3) of the points of a display."""
        return self._joined((0, 3), self._moved(display, Points))

    def lines(self, display: str | None = None) -> F64:
        """End points (N, 2, 3) of the lines of a display."""
        return self._joined((0, 2, 3), self._moved(display, Lines))

    def arrows(self, display: str | None = None) -> F64:
        """Tails and tips (N, 2, 3) of the arrows of a display that are drawn as `Arrows`."""
        return self._joined((0, 2, 3), self._moved(display, Arrows))

    def axes(self, display: str | None = None) -> F64:
        """Origins (N, 3) of the axes of a display."""
        return self._joined((0, 3), self._moved(display, Axes))

    def solids(self, display: str | None = None) -> F64:
        """Centres (N, 3) of the boxes, spheres, cylinders and cones of a display."""
        return self._joined((0, 3), self._moved(display, Instances))

    def meshes(self, display: str | None = None) -> list[F64]:
        """Return the vertices (N, 3) of each mesh of a display, except those with textures."""
        return list(self._moved(display, Mesh))

    def labels(self, display: str | None = None) -> dict[str, Vector]:
        """Return the positions of the labels of a display by text."""
        return {
            text: tuple(position)
            for pose, node in self._of(display, Labels)
            for text, position in zip(
                node.texts, _moved(pose, node.positions).tolist(), strict=True
            )
        }

    def images(self, display: str | None = None) -> list[tuple[Pose, Image]]:
        """Return the images of a display, such as a map, with their poses."""
        return self._of(display, Image)

    def poses(self, display: str | None = None) -> dict[str, Pose]:
        """Return the poses of the nodes of a display by key, such as the links of a robot."""
        return {key: pose for key, (pose, _) in self.nodes(display).items()}

    def is_drawn(self, display: str | None = None) -> bool:
        """Return whether a display draws anything visible."""
        prefix = self._prefix(display)
        with self.scene.lock:
            return self._has_content(prefix)

    # Inside

    def _drawn(self) -> dict[str, str]:
        """Names of the displays that draw something, by the prefix of their groups."""
        with self.scene.lock:
            return {
                prefix: _name(row)
                for row in self.state().rows
                if self._has_content(prefix := f"{row.id}/")
            }

    def _has_content(self, prefix: str) -> bool:
        return any(has_content(node) for _, _, node in self.scene.visible(prefix))

    def _row(self, display: str | None) -> Row:
        rows = self.state().rows
        if display is None and rows:
            return rows[0]
        found = [row for row in rows if _name(row) == display]
        if not found:
            hint = config_file.nearest(display or "", {_name(row) for row in rows})
            raise LookupError(f"No display is named `{display}`, {hint}")
        if len(found) > 1:
            raise LookupError(
                f"{len(found)} displays are named `{display}`. Give them different names."
            )
        return found[0]

    def _prefix(self, display: str | None) -> str:
        return f"{self._row(display).id}/"

    def _of(self, display: str | None, kind: type[N]) -> list[tuple[Pose, N]]:
        nodes = self.nodes(display).values()
        return [(pose, node) for pose, node in nodes if isinstance(node, kind)]

    def _moved(self, display: str | None, kind: type[N]) -> Iterator[F64]:
        for pose, node in self._of(display, kind):
            # The first field of a node has its coordinates.
            yield _moved(pose, getattr(node, fields(node)[0].name))  # pyright: ignore[reportArgumentType]

    @staticmethod
    def _joined(empty: tuple[int, ...], parts: Iterator[F64]) -> F64:
        return np.concatenate([np.empty(empty), *parts])


def _name(row: Row) -> str:
    """Return the name in the list of displays."""
    return row.name or row.type


def _moved(pose: Pose, xyz: NDArray[np.floating[Any]]) -> F64:
    """Coordinates (..., 3) of a node, transformed by its pose."""
    turned = np.asarray(xyz, np.float64).reshape(-1, 3) @ matrices(pose.wxyz).T
    return (turned + pose.position).reshape(xyz.shape)
