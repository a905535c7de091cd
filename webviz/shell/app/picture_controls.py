"""The part of `webviz.Viewer` that takes pictures, and looks at them."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import PIL.Image

from webviz.api.errors import Error
from webviz.api.views import View, with_type
from webviz.data.names import new_path
from webviz.files import config as config_file
from webviz.files.config import Settings
from webviz.shell.pictures import files as picture_files

if TYPE_CHECKING:
    from webviz.shell.pictures.browser import Pixels
    from webviz.shell.pictures.snapshots import Snapshots

ViewChoice = View | str | Mapping[str, Any] | None
"""A view, its values, the name of a saved one, or the default view."""


class PictureControls(ABC):
    """Takes pictures with a headless browser of this machine."""

    _snapshots: Snapshots

    @property
    @abstractmethod
    def settings(self) -> Settings:
        """Everything in the config except its lists."""

    @abstractmethod
    def fact(self, name: str, otherwise: Any = None) -> Any:
        """Return one field of the state."""

    @property
    @abstractmethod
    def url(self) -> str:
        """Address of the page for browsers on this machine."""

    def screenshot(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        size: tuple[int, int] = (1280, 720),
        view: ViewChoice = None,
    ) -> Pixels:
        """Make a picture of the scene as a new browser would show it, with images beside it.

        Takes seconds, and requires playwright and a browser on this machine.

        Args:
            path: file to write (.png, .jpg, .webp), if any.
            size: width and height in pixels.
            view: a view or the name of a saved one; None for the default view.

        Returns:
            uint8 (height, width, 3).

        Raises:
            Error: no browser is installed, or the file cannot be written.
        """
        if path is not None:
            picture_files.check(Path(path), is_animation=False, transparent=False)
        (pixels,) = self.screenshots([view], size=size)
        if path is not None:
            picture_files.save(PIL.Image.fromarray(pixels), Path(path))
        return pixels

    def screenshots(
        self, views: Sequence[ViewChoice], *, size: tuple[int, int] = (1280, 720)
    ) -> list[Pixels]:
        """Make pictures of several views with one browser, which is what takes long.

        Args:
            views: views or names of saved ones; None for the default view.
            size: width and height in pixels.

        Returns:
            uint8 (height, width, 3) each.

        Raises:
            Error: no browser is installed, or a view is unknown.
        """
        return self._snapshots.take(self.url, size, [self._view(view) for view in views])

    def select(
        self,
        x: int,
        y: int,
        *,
        size: tuple[int, int] = (1280, 720),
        view: ViewChoice = None,
    ) -> Mapping[str, Any]:
        """Select what a picture of this size and view has at a pixel, as a click does.

        Takes seconds, as `screenshot` does.

        Returns:
            What is known of each thing by number: `title`, `name` of its display, `tree` of its
            values and `note`; and "/info" on all. Empty if nothing is there.

        Raises:
            Error: no browser is installed, or the view is unknown.
        """
        return self._snapshots.select(self.url, size, self._view(view), (x, y))

    def _view(self, view: ViewChoice) -> View | None:
        if isinstance(view, str):
            if view not in (saved := self.settings.views):
                hint = config_file.nearest(view, saved)
                raise Error(f"Unknown saved view `{view}`: {hint}")
            view = saved[view]
        return None if view is None else checked_view(view)

    def save_screenshot(self) -> Path:
        """Save a picture of the scene next to the config, named by the time."""
        path = new_path("webviz_screenshot", ".png", Path(self.fact("file").folder))
        self.screenshot(path)
        return path


def checked_view(view: View | Mapping[str, Any]) -> View:
    """Return a validated view.

    Raises:
        Error: a value is invalid.
    """
    values = with_type(msgspec.to_builtins(view))
    try:
        return msgspec.convert(values, View)
    except msgspec.ValidationError as error:
        fault = config_file.explain(error, View, values)
        raise Error(f"Invalid view: {config_file.sentences([fault])}") from error
