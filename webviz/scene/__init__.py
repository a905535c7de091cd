"""The scene in every browser: viser behind webviz's own terms."""

from webviz.scene.listener import CannotListen, PortInUse
from webviz.scene.scene import Scene
from webviz.scene.server import open_server, set_background
from webviz.scene.typed import on_typed

__all__ = [
    "CannotListen",
    "PortInUse",
    "Scene",
    "on_typed",
    "open_server",
    "set_background",
]
