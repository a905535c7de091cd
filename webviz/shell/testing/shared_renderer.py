"""One browser for the pictures of all tests, in its own thread."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from webviz.api.views import View
from webviz.shell.pictures.browser import BrowserDied, NoBrowser, Pixels, launched
from webviz.shell.pictures.headless_renderer import HeadlessRenderer
from webviz.shell.testing.recording import RecordingScene

__tracebackhide__ = True  # failures are shown where the test calls

Size = tuple[int, int]
T = TypeVar("T")


class SharedRenderer:
    """Makes pictures of scenes; the browser is launched for the first one.

    playwright must be called from one thread without an asyncio loop, and other plug-ins of pytest
    may run a loop in the thread of the tests.
    """

    def __init__(self) -> None:
        self._thread: ThreadPoolExecutor | None = None
        self._open = contextlib.ExitStack()
        self._renderer: HeadlessRenderer | None = None
        self._scene: RecordingScene | None = None
        self._look: tuple[View, Size] | None = None

    def close(self) -> None:
        """Close the browser; another picture would launch a new one."""
        if self._thread is not None:
            self._call(self._forget)
            self._thread.shutdown()
            self._thread = None

    def capture(
        self,
        scene: RecordingScene,
        view: View,
        size: Size,
        transparent: bool = False,
        hidden: str | None = None,
    ) -> Pixels:
        """Return the picture of a scene.

        Args:
            scene: to draw, instead of the previous one.
            view: of the camera.
            size: width and height in pixels.
            transparent: omit the background.
            hidden: prefix of the names of groups to omit.

        Returns:
            uint8 (height, width, 3), or (height, width, 4) if transparent.

        Raises:
            NoBrowser: no browser was found.
            BrowserDied: the browser crashed; the next picture launches a new one.
        """

        def capture() -> Pixels:
            renderer = self._show(scene, view, size)
            with self._hidden(renderer, scene, hidden):
                pixels = renderer.capture(transparent)
            if errors := renderer.page.errors:
                text = " ".join(errors)
                errors.clear()
                raise AssertionError(f"Scripts of the page failed: {text}")
            return pixels

        return self._call(capture)

    def forget(self, scene: RecordingScene) -> None:
        """Stop showing a scene."""
        if self._scene is scene:
            self._call(self._leave)

    # In the thread

    def _call(self, work: Callable[[], T]) -> T:
        def attempt() -> T:
            try:
                return work()
            except BrowserDied:
                self._forget()
                raise

        if self._thread is None:
            self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="webviz-pictures")
        try:
            return self._thread.submit(attempt).result()
        except (NoBrowser, BrowserDied) as error:
            raise type(error)(str(error)) from None

    def _show(self, scene: RecordingScene, view: View, size: Size) -> HeadlessRenderer:
        if self._renderer is None:
            browser = self._open.enter_context(launched())
            self._renderer = HeadlessRenderer(browser, *size)
            self._open.callback(self._renderer.close)
        if self._scene is not scene:
            self._leave()
            self._scene = scene
            scene.attach(self._renderer.scene)
        if self._look is None or self._look[1] != size:
            self._renderer.resize(*size)
        if self._look is None or self._look[0] != view:
            self._renderer.look(view)
        self._look = view, size
        return self._renderer

    @contextlib.contextmanager
    def _hidden(
        self, renderer: HeadlessRenderer, scene: RecordingScene, prefix: str | None
    ) -> Iterator[None]:
        if prefix is None:
            yield
            return
        with scene.lock:  # nothing moves meanwhile
            groups = [g for g in scene.groups if g.startswith(prefix) and g not in scene.hidden]
            try:
                for group in groups:
                    renderer.scene.set_visible(group, False)
                renderer.scene.flush()
                yield
            finally:
                for group in groups:
                    renderer.scene.set_visible(group, True)
                renderer.scene.flush()

    def _leave(self) -> None:
        if self._scene is not None:
            self._scene.detach()
        self._scene = None

    def _forget(self) -> None:
        self._leave()
        self._renderer = self._look = None
        self._open.close()
