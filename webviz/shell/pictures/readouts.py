"""The text of messages, in pictures without a page around the scene."""

from __future__ import annotations

from collections.abc import Iterator

from PIL import Image

from webviz.api.pictures import Readout
from webviz.data.messages.tree import Tree
from webviz.shell.pictures.files import pen

FONT_PX = 13
LINE_PX = 18
INDENT_PX = 12
MARGIN_PX = 6
MAX_CHARACTERS = 200
BACKGROUND = (28, 31, 36)
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
