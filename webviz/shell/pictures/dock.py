"""The panes beside the scene, in pictures without a page around the scene."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from PIL import Image

from webviz.api.decoded import opened
from webviz.api.nodes import Pane
from webviz.api.pictures import Encoded, Pixels, Readout, Video
from webviz.data.messages.tree import Tree
from webviz.shell.pictures import browser
from webviz.shell.pictures.files import pen

FONT_PX = 13
LINE_PX = 18
INDENT_PX = 12
MARGIN_PX = 6
MAX_CHARACTERS = 200
QUIET = (150, 158, 168)
TEXT = (230, 233, 237)


def written(readout: Readout, size: tuple[int, int]) -> Image.Image:
    """Return a readout as a picture; what does not fit is cut off.

    Args:
        readout: of a pane.
        size: width and height in pixels.
    """
    sheet = Image.new("RGB", size, BACKGROUND)
    draw, font = pen(sheet, FONT_PX)
    lines = [(0, " · ".join(filter(None, (readout.topic, readout.type))), "")]
    lines += _lines(readout.tree(), 0)
    for row, (depth, name, value) in enumerate(lines[: size[1] // LINE_PX + 1]):
        x, y = MARGIN_PX + depth * INDENT_PX, MARGIN_PX + row * LINE_PX
        draw.text((x, y), name, QUIET, font)
        x += round(draw.textlength(name, font)) + MARGIN_PX
        draw.text((x, y), value[:MAX_CHARACTERS], TEXT, font)
    return sheet


def _lines(tree: Tree, depth: int) -> Iterator[tuple[int, str, str]]:
    """Depth, name and value of each line."""
    if isinstance(tree, str):
        yield depth, "", tree
        return
    for name, inside in tree["fields"].items():
        if isinstance(inside, str):
            yield depth, name, inside
        elif "fields" in inside:
            yield depth, name, ""
            yield from _lines(inside, depth + 1)
        elif all(isinstance(item, str) for item in inside["items"]):
            rest = inside["length"] - len(inside["items"])
            more = f", … ({inside['length']})" if rest else ""
            yield depth, name, f"[{', '.join(inside['items'])}{more}]"
        else:
            yield depth, name, f"{inside['length']} in all"
            for index, item in enumerate(inside["items"]):
                yield depth + 1, f"[{index}]", ""
                yield from _lines(item, depth + 2)


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
            pane_image = page.pane(own, pane, room, hidden.get(display, ()))
        else:
            pane_image = _fitting(own, room)
        place = GAP + (room[0] - pane_image.width) // 2, top + (room[1] - pane_image.height) // 2
        sheet.paste(pane_image, place)
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
