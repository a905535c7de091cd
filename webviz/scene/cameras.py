"""Places the cameras of browsers, and reports their views."""

from __future__ import annotations

import contextlib
import itertools
import threading
from collections.abc import Mapping
from typing import TypeVar

import msgspec
import numpy as np
import viser

from webviz.api.views import (
    ASSUMED_PX,
    FIXED_FRAME,
    Camera,
    Orbit,
    View,
    camera_of,
    options_of,
    target_group,
    type_of,
    view_of,
)
from webviz.scene.adapter import Adapter
from webviz.scene.names import node_path
from webviz.server.channel.messages import PlaceCamera, SaveCanvas, StartView, ViewReport

M = TypeVar("M", bound=PlaceCamera)


class _Browser(msgspec.Struct):
    """The camera of a browser.

    Args:
        view: requested last; its values hold until the page has confirmed the request.
        number: of that request.
        obeyed: the last request that the page confirmed.
        size: width and height of its picture in pixels.
    """

    view: View
    number: int
    obeyed: int
    size: tuple[float, float]


class ViserCameras:
    """The cameras of all browsers of a server, which users move independently.

    All methods belong to one thread, which takes the reports of pages when it needs them.

    Args:
        link: to the server.
    """

    def __init__(self, link: Adapter) -> None:
        self._link = link
        self._start: View = Orbit()
        self._numbers = itertools.count(1)
        self._browsers: dict[int, _Browser] = {}
        self._lock = threading.Lock()
        self._heard: dict[int, ViewReport] = {}
        """The newest report of each browser that was not taken yet."""
        link.channel.on(ViewReport, self._hear)
        link.server.on_client_connect(self._join)
        link.server.on_client_disconnect(self._leave)

    def start_with(self, view: View) -> None:
        """Choose the view of browsers that join.

        The page puts its camera there. viser's initial camera would come with every connection, and
        take browsers whose connection was lost away from where they were.
        """
        self._start = view

    def show(self, view: View, browser: int | None = None) -> None:
        """Show a view in one browser or in all of them.

        The camera follows the target frame if its `target_group` is in the scene.
        """
        self._take_reports()
        number = next(self._numbers)
        for id_ in self._link.server.get_clients():
            if browser in (None, id_):
                if camera := self._browsers.get(id_):
                    camera.view, camera.number = view, number
                self._link.channel.send(placed(PlaceCamera, view, number), id_)

    def views(self) -> Mapping[int, View]:
        """Return the current view of every browser, by its id."""
        clients = self._take_reports()
        return {id_: self._view(camera, clients[id_]) for id_, camera in self._browsers.items()}

    def target_frames(self) -> set[str]:
        """Return the target frames of all views, including that of browsers that join."""
        self._take_reports()
        views = [self._start, *(camera.view for camera in self._browsers.values())]
        return {view.target_frame for view in views} - {FIXED_FRAME}

    def size(self, browser: int) -> tuple[float, float]:
        """Width and height of the picture in a browser, in pixels.

        Raises:
            KeyError: the browser is unknown.
        """
        self._take_reports()
        return self._browsers[browser].size

    def save_image(self, name: str, browser: int | None = None) -> None:
        """Make one browser or all of them download their picture as a PNG of that name."""
        self._link.channel.send(SaveCanvas(name), browser)

    def _take_reports(self) -> dict[int, viser.ClientHandle]:
        """Apply the reports of pages, and return the connected browsers."""
        with self._lock:
            heard, self._heard = self._heard, {}
        clients = self._link.server.get_clients()
        for id_ in self._browsers.keys() - clients.keys():
            del self._browsers[id_]
        for id_, report in heard.items():
            if id_ not in clients:
                continue
            size = (max(report.width, 1.0), max(report.height, 1.0))
            if camera := self._browsers.get(id_):
                camera.obeyed, camera.size = report.number, size
            else:
                with contextlib.suppress(msgspec.ValidationError):  # not webviz's page
                    view = msgspec.convert({"type": report.view} | report.options, View)
                    self._browsers[id_] = _Browser(view, report.number, report.number, size)
        return clients

    def _view(self, browser: _Browser, client: viser.ClientHandle) -> View:
        if browser.obeyed != browser.number:
            return browser.view
        position, (w, x, y, z), pivot = self._link.camera(client)
        forward = np.array((2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))
        camera = Camera(position, position + forward * np.linalg.norm(pivot - position))
        return view_of(browser.view, camera, browser.size[1])

    # Called on viser's event loop

    async def _join(self, client: viser.ClientHandle) -> None:
        self._link.channel.send(placed(StartView, self._start, 0), client.client_id)

    async def _leave(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._heard.pop(client.client_id, None)

    def _hear(self, browser: int, report: ViewReport) -> None:
        with self._lock:
            self._heard[browser] = report


def placed(kind: type[M], view: View, number: int) -> M:
    """Return the message that puts the camera of a page where a view says.

    Args:
        kind: of the message.
        view: to show.
        number: of the request.
    """
    camera = camera_of(view, ASSUMED_PX)
    frame = view.target_frame
    return kind(
        number=number,
        view=type_of(view),
        options=options_of(view),
        frame="" if frame == FIXED_FRAME else node_path(target_group(frame)),
        position=camera.position.tolist(),
        look_at=camera.look_at.tolist(),
        scale=getattr(view, "scale", None),
    )
