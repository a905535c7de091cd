"""Content of bug reports: the picture of a page, and the tree of transforms."""

from __future__ import annotations

import base64
import io
import zipfile
from pathlib import Path

import PIL.Image
import pytest

import webviz
from webviz.commands import SaveReport
from webviz.data.messages import encode
from webviz.engine.commands import Refresh
from webviz.features.reports.writing import MAX_PICTURE, MAX_PIXELS, read_picture
from webviz.shell.testing import header
from webviz.shell.testing.source import SECOND, HandFedSource

TF = "tf2_msgs/msg/TFMessage"
PATH = "nav_msgs/msg/Path"


def picture(size: tuple[int, int] = (2, 1), kind: str = "PNG", behind: int = 0) -> str:
    """Return an image as a page sends it, with so many bytes behind its end."""
    PIL.Image.new("1", size).convert("1" if kind == "PNG" else "L").save(
        data := io.BytesIO(), format=kind
    )
    return base64.b64encode(data.getvalue() + bytes(behind)).decode()


@pytest.mark.parametrize(("kind", "ending"), [("PNG", ".png"), ("JPEG", ".jpg")])
def test_a_picture_is_a_member_with_the_ending_of_its_format(kind: str, ending: str) -> None:
    found = read_picture(sent := picture(kind=kind))
    assert found is not None
    assert found[0].endswith(ending)
    assert found[1] == base64.b64decode(sent)


def test_no_picture_is_no_member() -> None:
    assert read_picture("") is None


@pytest.mark.parametrize("sent", ["%", "AAAA", picture(kind="GIF"), picture()[:40]])
def test_what_is_no_picture_is_refused(sent: str) -> None:
    with pytest.raises(webviz.Error, match="not a PNG or JPEG"):
        read_picture(sent)


def test_a_picture_may_have_16_megabytes() -> None:
    size = len(base64.b64decode(picture()))
    assert read_picture(picture(behind=MAX_PICTURE - size)) is not None
    with pytest.raises(webviz.Error, match="too large"):
        read_picture(picture(behind=MAX_PICTURE - size + 1))


def test_a_picture_may_have_50_million_pixels() -> None:
    assert read_picture(picture((MAX_PIXELS // 5000, 5000))) is not None
    with pytest.raises(webviz.Error, match="too large"):
        read_picture(picture((MAX_PIXELS // 5000 + 1, 5000)))


@pytest.mark.parametrize("is_placed", [False, True])
def test_the_tree_of_transforms_is_a_member(tmp_path: Path, is_placed: bool) -> None:
    source = HandFedSource()
    with webviz.Viewer(port=0, source=source) as viewer:
        viewer.config = {"displays": [{"type": "Path", "topic": "/plan"}, {"type": "TF"}]}
        for _ in range(2):
            viewer.do(Refresh())
            source.now += SECOND
            source.put("/plan", PATH, encode(PATH, {"header": header("map", source.now)}))
            if is_placed:
                link = {"header": header("map", source.now), "child_frame_id": "base_link"}
                source.put("/tf", TF, encode(TF, {"transforms": [link]}))
        viewer.do(SaveReport(path=str(tmp_path / "bug.zip")))
    with zipfile.ZipFile(tmp_path / "bug.zip") as members:
        said = members.read("frames.txt").decode()
    assert ("There are no transforms." in said) is not is_placed
    assert ("base_link" in said) is is_placed
