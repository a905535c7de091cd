"""The scene in every browser, drawn by viser."""

from webviz.edges.scene.adapter.background import set_background
from webviz.edges.scene.listener import CannotListen, PortInUse
from webviz.edges.scene.scene import ViserScene
from webviz.edges.scene.server import open_server

__all__ = [
    "CannotListen",
    "PortInUse",
    "ViserScene",
    "open_server",
    "set_background",
]
