"""Scenes of bug reports: of a headless browser that makes the picture, or of none."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from webviz.engine.pipeline.scene import Scene
from webviz.files.config import Config
from webviz.shell.doctor.scene import NoScene
from webviz.shell.pictures.browser import NoBrowser, launched
from webviz.shell.pictures.capture import SIZE
from webviz.shell.pictures.headless_renderer import HeadlessRenderer


class Pictured:
    """A scene, and the picture of it.

    Args:
        renderer: None for a scene without a picture.
    """

    def __init__(self, renderer: HeadlessRenderer | None) -> None:
        self._renderer = renderer
        self.scene: Scene = NoScene() if renderer is None else renderer.scene

    def png(self) -> bytes:
        """Return the picture as PNG, b"" if none is made."""
        import io

        import PIL.Image

        if self._renderer is None:
            return b""
        file = io.BytesIO()
        PIL.Image.fromarray(self._renderer.capture()).save(file, "PNG")
        return file.getvalue()


@contextlib.contextmanager
def reported_scene(config: Config, wants_picture: bool) -> Iterator[tuple[Pictured, str]]:
    """Provide a scene for a report, and why there will be no picture although one is wanted."""
    problem = ""
    if wants_picture:
        with contextlib.ExitStack() as stack:
            try:
                browser = stack.enter_context(launched())
                renderer = HeadlessRenderer(browser, *SIZE)
            except NoBrowser as error:
                problem = str(error)
            else:
                stack.callback(renderer.close)
                renderer.look(config.settings.view)
                yield Pictured(renderer), ""
                return
    yield Pictured(None), problem
