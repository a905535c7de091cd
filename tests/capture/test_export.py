"""`webviz export`: a run as one file, opened from the disk by a real browser."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import PIL.Image
import playwright.sync_api as playwright
import pytest
from drives import CONFIG, recorded
from playwright.sync_api import expect

import webviz
from webviz.shell.cli import main as cli
from webviz.shell.pictures.browser_scripts import CANVAS, COUNT_UNPACKING, OPAQUE, SETTLE
from webviz.shell.pictures.headless_renderer import HeadlessRenderer

TIMES = (1.0, 4.5, 0.5, 5.0, 2.0, 0.0)
SIZE: playwright.ViewportSize = {"width": 800, "height": 500}


class OpenFile:
    """A file that a browser has opened from the disk, without a network.

    Args:
        page: an empty one.
        path: of the file.
    """

    def __init__(self, page: playwright.Page, path: Path) -> None:
        self.page = page
        self.requests: list[str] = []
        page.on("request", lambda request: self.requests.append(request.url))
        page.add_init_script(COUNT_UNPACKING)
        page.goto(path.as_uri())
        page.wait_for_function("window.webviz?.hasView()")

    def seek(self, at_s: float) -> None:
        """Type a time, and wait until the page shows it."""
        field = self.page.get_by_label("Go to time")
        field.fill(f"{at_s:g}")
        field.press("Enter")
        expect(field).to_have_value(f"0:00:0{at_s:.3f}")
        assert self.page.evaluate(SETTLE, 60_000.0)

    def pixels(self) -> np.ndarray:
        """The picture of the scene, uint8 (H, W, 3)."""
        png = base64.b64decode(self.page.evaluate(OPAQUE).split(",")[1])
        return np.asarray(PIL.Image.open(io.BytesIO(png)).convert("RGB"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With a bag, its config, and the file that was exported."""
    folder = tmp_path_factory.mktemp("export")
    recorded().write(folder / "run")
    (folder / "lab.yaml").write_text(CONFIG)
    arguments = [str(folder / "run"), "-d", str(folder / "lab.yaml")]
    assert cli(["export", *arguments, "-o", str(folder / "run.html")]) == 0
    return folder


@pytest.fixture(scope="module")
def file(folder: Path, browser: playwright.Browser) -> Iterator[OpenFile]:
    """The file, opened."""
    context = browser.new_context(viewport=SIZE, offline=True, color_scheme="dark")
    yield OpenFile(context.new_page(), folder / "run.html")
    context.close()


def test_the_file_shows_what_the_viewer_shows_at_any_time_in_any_order(
    folder: Path, file: OpenFile, renderer: HeadlessRenderer
) -> None:
    size = tuple(file.page.evaluate(CANVAS))
    shots = webviz.capture(
        CONFIG, bag=folder / "run", at=sorted(TIMES), size=size, renderer=renderer
    )
    wanted = {picture.at_s: picture.pixels for picture in shots.pictures}
    assert len({pixels.tobytes() for pixels in wanted.values()}) == len(TIMES)
    for at_s in TIMES:
        file.seek(at_s)
        np.testing.assert_array_equal(file.pixels(), wanted[at_s], f"at {at_s} s")


def test_the_file_asks_no_server_for_anything(file: OpenFile) -> None:
    others = [url for url in file.requests if not url.startswith(("blob:", "data:"))]
    assert len(others) == 1
