"""The scene in every browser, drawn by viser."""

from webviz.scene.adapter.image import set_background
from webviz.scene.scene import ViserScene
from webviz.scene.server import open_server
from webviz.server.http.listener import CannotListen, PortInUse

__all__ = [
    "CannotListen",
    "PortInUse",
    "ViserScene",
    "open_server",
    "set_background",
]
