"""A scene that shows nothing, for viewers whose statuses alone are of interest."""

from __future__ import annotations

from webviz.api.bounds import Box
from webviz.api.declared import Color
from webviz.api.nodes import POINTS_HELD, Node, Pose
from webviz.engine.pipeline.browsers import Browsers, NoBrowsers
from webviz.engine.pipeline.scene import Cameras, NoCameras


class NoScene:
    """A scene that claims a browser, so that displays draw."""

    cameras: Cameras = NoCameras()
    browsers: Browsers = NoBrowsers()

    def set_pose(self, group: str, pose: Pose) -> None:
        """No effect."""

    def set_visible(self, group: str, visible: bool) -> None:
        """No effect."""

    def upsert(self, group: str, key: str, node: Node, pose: Pose) -> None:
        """No effect."""

    def remove(self, group: str, key: str) -> None:
        """No effect."""

    def remove_group(self, group: str) -> None:
        """No effect."""

    def bounds(self, prefix: str, most: int = 0) -> Box | None:
        """None."""
        return None

    def flush(self) -> None:
        """No effect."""

    def has_watchers(self) -> bool:
        """Return True."""
        return True

    def is_unseen(self, display: str) -> bool:
        """Return False."""
        return False

    def points_held(self) -> int:
        """Return the usual number of points."""
        return POINTS_HELD

    def set_background(self, rgb: Color | None) -> None:
        """No effect."""
