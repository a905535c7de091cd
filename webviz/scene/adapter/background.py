"""The colour behind a scene."""

from __future__ import annotations

import numpy as np
import viser
from viser import _messages as wire

from webviz.api.nodes import Rgb
from webviz.scene.png import encode_png


def set_background(server: viser.ViserServer, rgb: Rgb | None) -> None:
    """Set the background to one colour; None is that of each page, which follows its theme.

    viser's way to do it imports all plug-ins of imageio and Pillow, a twentieth of webviz's start.
    """
    pixel = None if rgb is None else encode_png(np.array([[(*rgb, 255)]], np.uint8))
    server._websock_server.queue_message(wire.BackgroundImageMessage("png", pixel, None))
