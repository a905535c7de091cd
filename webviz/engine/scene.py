"""What the viewer needs of a scene and of its cameras."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from webviz.api.bounds import Box
from webviz.api.declared import Color
from webviz.api.nodes import Pose
from webviz.api.views import View
from webviz.engine.pipeline.drawing import Scene as DrawingScene


class Cameras(Protocol):
    """The cameras of browsers; see `webviz.edges.scene.cameras.Cameras`."""

    def start_with(self, view: View) -> None:
        """Choose what browsers that join begin with."""
        ...

    def show(self, view: View, browser: int | None = None) -> None:
        """Put the camera of a browser, or of every one, where a view says."""
        ...

    def views(self) -> Mapping[int, View]:
        """What every browser shows now, by its id."""
        ...

    def target_frames(self) -> set[str]:
        """The frames that views follow, or begin to when a browser joins."""
        ...

    def size(self, browser: int) -> tuple[float, float]:
        """Width and height of the picture in a browser, in pixels."""
        ...

    def save_image(self, name: str, browser: int | None = None) -> None:
        """Let a browser, or every one, download what it shows."""
        ...


class NoCameras:
    """Of a scene that no browser shows."""

    def start_with(self, view: View) -> None:
        """Nobody begins."""

    def show(self, view: View, browser: int | None = None) -> None:
        """Nobody looks."""

    def views(self) -> Mapping[int, View]:
        """None."""
        return {}

    def target_frames(self) -> set[str]:
        """None."""
        return set()

    def size(self, browser: int) -> tuple[float, float]:
        """There is no such browser."""
        raise KeyError(browser)

    def save_image(self, name: str, browser: int | None = None) -> None:
        """Nobody downloads."""


class ViewedScene(Protocol):
    """What a scene has besides drawing, to be looked at; see `webviz.edges.scene.Scene`."""

    @property
    def cameras(self) -> Cameras:
        """Of all browsers."""
        ...

    def set_pose(self, group: str, pose: Pose) -> None:
        """Place a group in the fixed frame."""
        ...

    def remove_group(self, group: str) -> None:
        """Remove a group with all its nodes."""
        ...

    def bounds(self, prefix: str) -> Box | None:
        """The box around all that is visible of the groups of a prefix."""
        ...


class Scene(DrawingScene, ViewedScene, Protocol):
    """What the viewer needs of a scene besides drawing; see `webviz.edges.scene.Scene`."""

    def flush(self) -> None:
        """Send everything that changed since the last flush."""
        ...

    def has_watchers(self) -> bool:
        """Whether any browser is connected."""
        ...

    def set_background(self, rgb: Color) -> None:
        """Fill what lies behind everything with one colour."""
        ...
