"""Pictures of trees as PNG, drawn by the headless browser."""

from __future__ import annotations

import base64

from webviz.api.errors import Error
from webviz.data.transforms.picture import TreePicture
from webviz.shell.pictures.browser import LARGEST, launched


def to_png(picture: TreePicture) -> bytes:
    """Draw a picture.

    Raises:
        Error: it is too large, or no browser is installed.
    """
    if max(picture.width, picture.height) > LARGEST:
        raise Error(
            f"The picture would have {picture.width} x {picture.height} pixels; the limit is "
            f"{LARGEST} per side. Write an .svg file instead."
        )
    with launched() as browser:
        context = browser.new_context()
        try:
            tab = context.new_page()
            tab.set_viewport_size({"width": picture.width, "height": picture.height})
            # Scripts do not run in images, whatever the names of frames are.
            url = f"data:image/svg+xml;base64,{base64.b64encode(picture.svg.encode()).decode()}"
            tab.set_content(f'<!doctype html><style>body {{ margin: 0 }}</style><img src="{url}">')
            return tab.screenshot(type="png")
        finally:
            context.close()
