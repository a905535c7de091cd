"""The scene in every browser: viser behind webviz's own terms."""

from webviz.scene.listener import CannotListen, PortInUse
from webviz.scene.scene import Scene
from webviz.scene.server import open_server, set_background

__all__ = [
    "CannotListen",
    "PortInUse",
    "Scene",
    "open_server",
    "set_background",
]
