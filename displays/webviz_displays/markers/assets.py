"""The files that markers name: meshes and pictures, loaded outside the frame loop."""

from __future__ import annotations

import time
from collections.abc import Set

import numpy as np

from webviz import Context, Level
from webviz.data.memory import DECODING
from webviz.data.messages.markers import Content, Marker
from webviz_displays.markers.batch import MarkerBatch
from webviz_displays.markers.faults import Fault
from webviz_displays.markers.meshes import LoadedMesh
from webviz_displays.markers.nodes import Files
from webviz_urdf import (
    Loading,
    LoadRequest,
    MeshContent,
    PictureFile,
    RobotDescriptionError,
)

EMBEDDED = "embedded://"
"""Begins the URI of a file that is in the message."""
MAX_FILES = 500
"""Different files per display."""
RETRY_S = 30.0
"""Time in seconds until a file that could not be loaded is tried again; twice as long after each
failure."""
LONGEST_S = 600.0
"""Longest time in seconds between two tries."""


class Assets:
    """Meshes and pictures by what was requested."""

    def __init__(self) -> None:
        self._assets: dict[LoadRequest, LoadedMesh | PictureFile | str] = {}
        self._loading: dict[LoadRequest, Loading] = {}
        self._failed: dict[LoadRequest, tuple[float, float]] = {}
        """Times when files that could not be loaded are tried again, and how long that is after."""
        self._arrived: set[LoadRequest] = set()
        self._version = 0

    @property
    def loading(self) -> int:
        """Return the number of files being loaded for the first time."""
        return sum(request not in self._assets for request in self._loading)

    def version(self) -> int:
        """Return what changes when `load` is to be called, as when failed files are due again."""
        now = time.monotonic()
        due = [request for request, (at, _) in self._failed.items() if at <= now]
        for request in due:
            self._loading.setdefault(request, Loading(request))
            self._failed[request] = float("inf"), self._failed[request][1]
        self._version += bool(due)
        return self._version

    def load(self, ctx: Context, used: Set[LoadRequest]) -> set[LoadRequest]:
        """Go on loading; what has arrived or changed since the last call.

        Args:
            ctx: has the workers.
            used: what markers name. Other files are dropped if there are many, if little memory is
                left, or if they came in a message.
        """
        is_tight = len(self._assets) > MAX_FILES // 2 or DECODING.is_scarce
        self._assets = {
            request: v
            for request, v in self._assets.items()
            if request in used or not (is_tight or request.data)
        }
        self._failed = {request: v for request, v in self._failed.items() if request in used}
        self._loading = {request: v for request, v in self._loading.items() if request in used}
        self._take(ctx)
        arrived, self._arrived = self._arrived, set()
        return arrived

    def start(self, ctx: Context) -> None:
        """Begin to load what `of` found missing."""
        self._take(ctx)
        self._version += bool(self._arrived)

    def _take(self, ctx: Context) -> None:
        """Take the results that are ready."""
        for request, loading in list(self._loading.items()):
            try:
                result = ctx.background(loading, loading.run, stop=loading.stop)
            except RobotDescriptionError as error:
                result = str(error)
                self._fail(request)
            if result is None:
                continue
            del self._loading[request]
            if not isinstance(result, str):
                self._failed.pop(request, None)
            if isinstance(result, MeshContent):
                name = f"{request.mesh} {len(self._assets)}" if request.data else request.mesh
                result = LoadedMesh(name, result)
            if result != self._assets.get(request):
                self._assets[request] = result
                self._arrived.add(request)

    def _fail(self, request: LoadRequest) -> None:
        if request.data:
            return  # what is in a message stays as it is
        _, pause_s = self._failed.get(request, (0.0, RETRY_S / 2.0))
        pause_s = min(2.0 * pause_s, LONGEST_S)
        self._failed[request] = time.monotonic() + pause_s, pause_s

    def of(self, batch: MarkerBatch) -> tuple[Files, list[Fault], set[LoadRequest]]:
        """Return files, faults and file names of markers."""
        meshes: dict[int, LoadedMesh] = {}
        pictures: dict[int, bytes] = {}
        faults: list[Fault] = []
        requests: set[LoadRequest] = set()
        has_file = (batch.types == Marker.MESH_RESOURCE) | (batch.types == Marker.TRIANGLE_LIST)
        for row in np.flatnonzero(has_file).tolist():
            request = _request(int(batch.types[row]), batch.contents[row])
            if isinstance(request, str):
                faults.append((row, Level.ERROR, request))
            elif request is not None:
                requests.add(request)
                asset = self._asset(request)
                if isinstance(asset, str):
                    faults.append((row, Level.ERROR, asset))
                elif isinstance(asset, LoadedMesh):
                    meshes[row] = asset
                elif asset is not None:
                    pictures[row] = asset.data
        return Files(meshes, pictures), faults, requests

    def _asset(self, request: LoadRequest) -> LoadedMesh | PictureFile | str | None:
        """Return a mesh, a picture, why there is none, or None while it is being loaded."""
        if request in self._assets:
            return self._assets[request]
        if request not in self._loading:
            if len(self._assets) + len(self._loading) >= MAX_FILES:
                return f"The markers of this display name more than {MAX_FILES} files."
            self._loading[request] = Loading(request)
        return None


def _request(type_: int, content: Content) -> LoadRequest | str | None:
    """Return the file that a marker names, None if it names none, or why that is impossible."""
    if type_ == Marker.MESH_RESOURCE:
        uri = content.mesh_resource
        if not uri.startswith(EMBEDDED):
            return LoadRequest(mesh=uri) if uri else None
        data, name = content.mesh_file.data, content.mesh_file.filename
        if not len(data):
            return f"{uri:.80} is not in the message: mesh_file.data is empty."
        return LoadRequest(mesh=name or uri, data=data.tobytes())
    uri = content.texture_resource
    if not uri:
        return None
    if len(content.uv_coordinates) != len(content.points):
        counts = f"{len(content.uv_coordinates)} for {len(content.points)} points"
        return f"The texture needs one uv coordinate per point, there are {counts}."
    if not uri.startswith(EMBEDDED):
        return LoadRequest(picture=uri)
    if not len(content.texture.data):
        return f"{uri:.80} is not in the message: texture.data is empty."
    return LoadRequest(picture=uri, data=content.texture.data.tobytes())
