"""The panes beside the scene, in pictures without a page around the scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from PIL import Image

from webviz.api.decoded import opened
from webviz.api.nodes import Pane
from webviz.api.pictures import Encoded, Pixels, Readout, Video
from webviz.shell.pictures import browser
from webviz.shell.pictures.readouts import written

SHARE = 0.3
"""Share of the width of a picture."""
GAP = 2
"""Pixels between panes."""
BACKGROUND = (28, 31, 36)


def with_panes(
    page: browser.Page,
    scene: browser.Pixels,
    panes: Mapping[str, Pane],
    hidden: Mapping[str, Sequence[str]],
) -> browser.Pixels:
    """Return a picture of a scene with panes at its right, one below the other.

    The scene loses its sides, as in a narrower window: its vertical field of view stays.

    Args:
        page: draws panes that show more than the picture.
        scene: uint8 (H, W, 3) or (H, W, 4).
        panes: by display, from top to bottom; those with a video are left out.
        hidden: ids of the displays that a pane leaves out, by its display.
    """
    stills = {each: pane for each, pane in panes.items() if not isinstance(pane.picture, Video)}
    if not stills:
        return scene
    height, width = scene.shape[:2]
    dock = max(1, round(width * SHARE))
    sheet = Image.new("RGB", (dock, height), BACKGROUND)
    for index, (display, pane) in enumerate(stills.items()):
        top, bottom = (round(height * place / len(stills)) for place in (index, index + 1))
        room = max(1, dock - GAP), max(1, bottom - top - (GAP if index + 1 < len(stills) else 0))
        sheet.paste((0, 0, 0), (GAP, top, GAP + room[0], top + room[1]))
        if isinstance(pane.picture, Readout):
            sheet.paste(written(pane.picture, room), (GAP, top))
            continue
        assert isinstance(pane.picture, Pixels | Encoded)
        own = opened(pane.picture)
        if pane.camera or pane.marks:
            shown = page.pane(own, pane, room, hidden.get(display, ()))
        else:
            shown = _fitting(own, room)
        place = GAP + (room[0] - shown.width) // 2, top + (room[1] - shown.height) // 2
        sheet.paste(shown, place)
    whole = np.full_like(scene, 255)
    left = dock // 2
    whole[:, : width - dock] = scene[:, left : left + width - dock]
    whole[:, width - dock :, :3] = np.asarray(sheet)
    return whole


def _fitting(picture: Image.Image, room: tuple[int, int]) -> Image.Image:
    """Return a picture as large as there is room."""
    scale = min(room[0] / picture.width, room[1] / picture.height)
    size = max(1, round(picture.width * scale)), max(1, round(picture.height * scale))
    return picture.convert("RGB").resize(size, Image.Resampling.BOX)
