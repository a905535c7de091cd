"""The panes beside the scene, in pictures without a page around the scene."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PIL import Image

from webviz.api.nodes import Pane
from webviz.api.pictures import Readout, Video
from webviz.api.stills import opened
from webviz.shell.pictures.browser import Pixels
from webviz.shell.pictures.readouts import written

SHARE = 0.3
"""Of the width of a picture."""
GAP = 2
"""Pixels between panes."""
BACKGROUND = (28, 31, 36)


def with_panes(scene: Pixels, panes: Sequence[Pane]) -> Pixels:
    """A picture of a scene with panes at its right, one below the other.

    The scene loses its sides, as in a narrower window: its vertical field of view stays.

    Args:
        scene: uint8 (H, W, 3) or (H, W, 4).
        panes: from top to bottom; those with a video are left out, which only browsers decode.
    """
    stills = [pane.picture for pane in panes if not isinstance(pane.picture, Video)]
    if not stills:
        return scene
    height, width = scene.shape[:2]
    dock = max(1, round(width * SHARE))
    sheet = Image.new("RGB", (dock, height), BACKGROUND)
    for index, picture in enumerate(stills):
        top, bottom = (round(height * place / len(stills)) for place in (index, index + 1))
        room = max(1, dock - GAP), max(1, bottom - top - (GAP if index + 1 < len(stills) else 0))
        sheet.paste((0, 0, 0), (GAP, top, GAP + room[0], top + room[1]))
        if isinstance(picture, Readout):
            sheet.paste(written(picture, room), (GAP, top))
            continue
        shown = opened(picture)
        scale = min(room[0] / shown.width, room[1] / shown.height)
        size = max(1, round(shown.width * scale)), max(1, round(shown.height * scale))
        shown = shown.convert("RGB").resize(size, Image.Resampling.BOX)
        place = GAP + (room[0] - size[0]) // 2, top + (room[1] - size[1]) // 2
        sheet.paste(shown, place)
    whole = np.full_like(scene, 255)
    left = dock // 2
    whole[:, : width - dock] = scene[:, left : left + width - dock]
    whole[:, width - dock :, :3] = np.asarray(sheet)
    return whole
