"""The camera of every browser: where it is put, and which view it shows."""

from __future__ import annotations

import itertools
import json
from collections.abc import Mapping
from dataclasses import dataclass

import msgspec
import numpy as np
import viser

from webviz.api.views import (
    FIELD_OF_VIEW,
    FIXED_FRAME,
    VIEW_TYPES,
    Camera,
    Orbit,
    ThirdPersonFollower,
    View,
    camera_of,
    target_group,
    type_of,
    view_of,
)
from webviz.edges.scene.adapter import Adapter
from webviz.edges.scene.image_script import IMAGE_SCRIPT
from webviz.edges.scene.mouse_script import MOUSE_SCRIPT
from webviz.edges.scene.names import node_path
from webviz.edges.scene.view_script import REPORT, VIEW_SCRIPT, call

ASSUMED_PX = 800.0
"""Height of a picture that nobody has told yet; the page corrects the distance."""


class _Report(msgspec.Struct):
    """What a page tells when it has moved its camera, or changed its size.

    Args:
        number: of the last request it obeyed.
        type, target_frame: of the view it has.
        width, height: of its picture in CSS pixels.
    """

    number: int
    type: str
    target_frame: str
    width: float
    height: float


@dataclass
class _Browser:
    """What is known of the camera of one browser.

    Args:
        view: asked for last; its numbers hold until the page has told that it obeyed.
        number: of that request.
        obeyed: the last request that the page obeyed.
        size: width and height of its picture in pixels.
    """

    view: View
    number: int
    obeyed: int
    size: tuple[float, float]


class Cameras:
    """The cameras of all browsers of a server; each looks as its user wants.

    Args:
        link: to the server.
    """

    def __init__(self, link: Adapter) -> None:
        self._link = link
        self._start: View = Orbit()
        self._numbers = itertools.count(1)
        self._browsers: dict[int, _Browser] = {}
        link.on_told(REPORT, self._hear)
        for script in (VIEW_SCRIPT, MOUSE_SCRIPT, IMAGE_SCRIPT):
            link.run_javascript(script)
        link.server.on_client_connect(self._join)
        link.server.on_client_disconnect(self._leave)
        self.start_with(self._start)

    def start_with(self, view: View) -> None:
        """Choose what browsers that join begin with."""
        self._start = view
        camera = camera_of(view, ASSUMED_PX)
        initial = self._link.server.initial_camera
        initial.look_at = camera.look_at
        initial.position = camera.position
        initial.up = (0.0, 0.0, 1.0)
        initial.fov = FIELD_OF_VIEW

    def show(self, view: View, browser: int | None = None) -> None:
        """Put the camera of a browser, or of every one, where a view says.

        Its target frame is followed if `target_group` of it is in the scene.
        """
        number = next(self._numbers)
        for id_, client in self._link.server.get_clients().items():
            if browser in (None, id_):
                if known := self._browsers.get(id_):
                    known.view, known.number = view, number
                self._link.run_javascript(call("webvizView.show", _json(view, number)), client)

    def views(self) -> Mapping[int, View]:
        """What every browser shows now, by its id."""
        clients = self._link.server.get_clients()
        return {
            id_: self._view(known, clients[id_])
            for id_, known in tuple(self._browsers.items())
            if id_ in clients
        }

    def target_frames(self) -> set[str]:
        """The frames that views follow, or begin to when a browser joins."""
        views = [self._start, *(known.view for known in tuple(self._browsers.values()))]
        return {view.target_frame for view in views} - {FIXED_FRAME}

    def size(self, browser: int) -> tuple[float, float]:
        """Width and height of the picture in a browser, in pixels.

        Raises:
            KeyError: there is no such browser.
        """
        return self._browsers[browser].size

    def save_image(self, name: str, browser: int | None = None) -> None:
        """Let a browser, or every one, download what it shows as a PNG of that name."""
        for id_, client in self._link.server.get_clients().items():
            if browser in (None, id_):
                self._link.run_javascript(call("webvizImage.save", json.dumps(name)), client)

    def _view(self, known: _Browser, client: viser.ClientHandle) -> View:
        if known.obeyed != known.number:
            return known.view
        position, (w, x, y, z), pivot = self._link.camera(client)
        forward = np.array((2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))
        camera = Camera(position, position + forward * np.linalg.norm(pivot - position))
        return view_of(type(known.view), known.view.target_frame, camera, known.size[1])

    # Called on viser's event loop

    async def _join(self, client: viser.ClientHandle) -> None:
        # A page that only lost its connection keeps its camera, and tells of it.
        self._link.run_javascript(call("webvizView.join", _json(self._start, 0)), client)

    async def _leave(self, client: viser.ClientHandle) -> None:
        self._browsers.pop(client.client_id, None)

    def _hear(self, browser: int, text: str) -> None:
        try:
            report = msgspec.json.decode(text, type=_Report)
            view = VIEW_TYPES[report.type](target_frame=report.target_frame)
        except (msgspec.DecodeError, KeyError):
            return  # no page of ours says that
        size = (max(report.width, 1.0), max(report.height, 1.0))
        known = self._browsers.get(browser)
        if known is None:
            self._browsers[browser] = _Browser(view, report.number, report.number, size)
        else:
            known.obeyed, known.size = report.number, size


def _json(view: View, number: int) -> str:
    camera = camera_of(view, ASSUMED_PX)
    frame = view.target_frame
    return json.dumps(
        {
            "number": number,
            "type": type_of(view),
            "target_frame": frame,
            "frame": "" if frame == FIXED_FRAME else node_path(target_group(frame)),
            "turns": isinstance(view, ThirdPersonFollower),
            "position": camera.position.tolist(),
            "look_at": camera.look_at.tolist(),
            "scale": getattr(view, "scale", None),
        }
    )
