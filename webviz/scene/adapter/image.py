"""Images in the scene, and behind it."""

from __future__ import annotations

import numpy as np
import viser
from viser import ImageHandle
from viser import _messages as wire

from webviz.api.nodes import Rgb
from webviz.scene.png import encode_png

_BLANK = encode_png(np.zeros((1, 1, 4), np.uint8))


def set_background(server: viser.ViserServer, rgb: Rgb | None) -> None:
    """Set the background to one colour; None is that of each page, which follows its theme.

    viser's way to do it imports all plug-ins of imageio and Pillow, a twentieth of webviz's start.
    """
    pixel = None if rgb is None else encode_png(np.array([[(*rgb, 255)]], np.uint8))
    server._websock_server.queue_message(wire.BackgroundImageMessage("png", pixel, None))


def add_blank_image(server: viser.ViserServer, name: str) -> ImageHandle:
    """Add an image of one metre that shows nothing yet.

    viser's way to do it imports all plug-ins of imageio and Pillow, and takes the frame loop a
    millisecond or two for each tile of a map.
    """
    props = wire.ImageProps(
        _format="png",
        _data=_BLANK,
        render_width=1.0,
        render_height=1.0,
        cast_shadow=False,
        receive_shadow=False,
        scale=1.0,
    )
    message = wire.ImageMessage(name, props)
    pose = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    return ImageHandle._make(server.scene, message, name, *pose, visible=True)
