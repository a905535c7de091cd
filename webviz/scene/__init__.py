"""The scene in every browser: viser behind webviz's own terms."""

from webviz.scene.scene import Scene
from webviz.scene.server import CannotListen, PortInUse, open_server, set_background
from webviz.scene.view import move_cameras, set_view

__all__ = [
    "CannotListen",
    "PortInUse",
    "Scene",
    "move_cameras",
    "open_server",
    "set_background",
    "set_view",
]
