"""The interfaces of a scene and its cameras."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from webviz.api.bounds import Box
from webviz.api.declared import Color
from webviz.api.views import View
from webviz.engine.pipeline.browsers import Browsers
from webviz.engine.pipeline.scene_diff import SceneWriter


class Cameras(Protocol):
    """The cameras of browsers; see `webviz.scene.cameras.Cameras`."""

    def start_with(self, view: View) -> None:
        """Set the view that browsers start with."""
        ...

    def show(self, view: View, browser: int | None = None) -> None:
        """Show a view in one browser, or in all."""
        ...

    def views(self) -> Mapping[int, View]:
        """Return the current view of every browser, by its id."""
        ...

    def target_frames(self) -> set[str]:
        """Return the target frames of current views, and of the one that browsers start with."""
        ...

    def size(self, browser: int) -> tuple[float, float]:
        """Width and height of the picture in a browser, in pixels."""
        ...

    def save_image(self, name: str, browser: int | None = None) -> None:
        """Let one browser, or all, download their picture."""
        ...


class NoCameras:
    """The cameras of a scene without browsers."""

    def start_with(self, view: View) -> None:
        """No effect."""

    def show(self, view: View, browser: int | None = None) -> None:
        """No effect."""

    def views(self) -> Mapping[int, View]:
        """None."""
        return {}

    def target_frames(self) -> set[str]:
        """None."""
        return set()

    def size(self, browser: int) -> tuple[float, float]:
        """Fail, as no browser exists."""
        raise KeyError(browser)

    def save_image(self, name: str, browser: int | None = None) -> None:
        """No effect."""


class Scene(SceneWriter, Protocol):
    """A scene with browsers; see `webviz.scene.ViserScene`."""

    @property
    def cameras(self) -> Cameras:
        """The cameras of all browsers."""
        ...

    @property
    def browsers(self) -> Browsers:
        """The connected browsers."""
        ...

    def bounds(self, prefix: str, most: int = 0) -> Box | None:
        """Return the box around all visible groups of a prefix; see `webviz.api.bounds`."""
        ...

    def flush(self) -> None:
        """Send everything that changed since the last flush."""
        ...

    def has_watchers(self) -> bool:
        """Return whether any browser is connected."""
        ...

    def is_unseen(self, display: str) -> bool:
        """Return whether pages have a pane for a display id, but none has shown it for a while."""
        ...

    def points_held(self) -> int:
        """Return the number of points every connected browser draws fast enough."""
        ...

    def set_background(self, rgb: Color | None) -> None:
        """Set the background colour; None follows the theme of each page."""
        ...
