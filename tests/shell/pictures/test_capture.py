"""`webviz.capture`: pictures and statuses of a config, as a program gets them."""

from __future__ import annotations

import asyncio
import functools
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import webviz
from webviz import Level
from webviz.api.nodes import Labels
from webviz.api.status import Status
from webviz.api.views import Orbit
from webviz.files.opening import parse
from webviz.shell.pictures.capture import Capture, Picture
from webviz.shell.pictures.headless_renderer import HeadlessRenderer
from webviz.shell.pictures.offline_viewer import Readiness

SIZE = (320, 240)
CONFIG = (Path(__file__).parent / "top.yaml").read_text()
MARGIN_PX = 3
Captures = Callable[..., Capture]


@pytest.fixture
def capture(run: Path, renderer: HeadlessRenderer) -> Captures:
    """`webviz.capture` of the run in small pictures."""
    return functools.partial(webviz.capture, bag=run, size=SIZE, renderer=renderer)


def scan(pixels: NDArray[np.uint8]) -> NDArray[np.float64]:
    """Column and row of each pixel of the scan."""
    red, green, blue = (pixels[..., channel].astype(int) for channel in range(3))
    return np.argwhere((red > 200) & (green < 80) & (blue > 200))[:, ::-1].astype(float)


def column(x: float, distance: float = 20.0) -> float:
    """Return where a point at x is in a picture from straight above."""
    half = distance * np.tan(np.pi / 8)
    return SIZE[0] / 2 + x / half * SIZE[1] / 2


def test_a_picture_shows_the_robot_where_it_was(capture: Captures) -> None:
    shot: Capture = capture(CONFIG, at=2.0)
    assert (shot.pixels.shape, shot.pixels.dtype) == ((240, 320, 3), np.uint8)
    assert scan(shot.pixels).mean(axis=0)[0] == pytest.approx(column(2.1), abs=MARGIN_PX)
    assert shot.is_ok
    assert {name: status.level for name, status in shot.statuses.items()} == {"Scan": Level.OK}


@pytest.mark.parametrize("bad", [0, 1])
def test_pictures_are_ok_if_each_of_them_is(bad: int) -> None:
    levels = [Level.OK, Level.OK]
    assert Capture(tuple(map(picture_of, levels))).is_ok
    levels[bad] = Level.WARN
    assert not Capture(tuple(map(picture_of, levels))).is_ok


def picture_of(level: Level) -> Picture:
    """A picture of one display."""
    readiness = Readiness({"Scan": Status(level, "")}, {}, ("Scan",))
    return Picture(np.zeros((1, 1, 3), np.uint8), "", None, readiness)


def test_several_times_are_pictures_in_the_order_of_time(capture: Captures) -> None:
    shot: Capture = capture(CONFIG, at=["end", 1.0, 3.0])
    assert [picture.at_s for picture in shot.pictures] == [1.0, 3.0, 6.0]
    columns = [scan(picture.pixels).mean(axis=0)[0] for picture in shot.pictures]
    assert columns == pytest.approx([column(x + 0.1) for x in (1, 3, 6)], abs=MARGIN_PX)


def test_the_same_bag_makes_the_same_picture_and_the_same_words(capture: Captures) -> None:
    one, other = capture(CONFIG, at=2.5), capture(CONFIG, at=[0.7, 2.5])
    assert (one.pixels == other.pixels).all()
    assert one.statuses == other.statuses


def test_displays_keep_messages_before_the_time_of_the_picture(capture: Captures) -> None:
    decaying = CONFIG.replace("size: 0.6,", "size: 0.6, decay_time: 2.5,")
    shot: Capture = capture(decaying, at=5.0)
    columns = scan(shot.pixels)[:, 0]
    assert columns.min() == pytest.approx(column(2.5), abs=2 * MARGIN_PX)
    assert columns.max() == pytest.approx(column(5.2), abs=2 * MARGIN_PX)


def test_views_are_pictures_of_one_moment(capture: Captures) -> None:
    near = Orbit(distance=10.0, yaw=-1.570796, pitch=1.5697)
    shot: Capture = capture(CONFIG, at=1.0, views=["Far", near])
    assert [picture.view for picture in shot.pictures] == ["Far", "1"]
    far, near = (scan(picture.pixels) for picture in shot.pictures)
    assert far.mean(axis=0)[0] == pytest.approx(column(1.1, 40.0), abs=MARGIN_PX)
    assert near.mean(axis=0)[0] == pytest.approx(column(1.1, 10.0), abs=MARGIN_PX)


def test_a_frame_that_is_focused_is_in_the_middle(capture: Captures) -> None:
    shot: Capture = capture(CONFIG, at="end", focus="base")
    assert scan(shot.pixels).mean(axis=0) == pytest.approx(
        (column(0.1), SIZE[1] / 2), abs=MARGIN_PX
    )


def test_a_picture_without_background_is_transparent_around_displays(capture: Captures) -> None:
    shot: Capture = capture(CONFIG, at=1.0, transparent=True)
    assert shot.pixels.shape == (240, 320, 4)
    opaque = np.argwhere(shot.pixels[..., 3] > 128)[:, ::-1]
    assert opaque.mean(axis=0) == pytest.approx(scan(shot.pixels).mean(axis=0), abs=1)


def test_a_display_that_shows_nothing_is_reported_with_the_reason(capture: Captures) -> None:
    config = CONFIG + "- {type: Path, topic: /plan}\n- {type: Path, enabled: false}\n"
    shot: Capture = capture(config)
    assert not shot.is_ok
    assert shot.statuses.keys() == {"Scan", "Path"}
    assert shot.statuses["Path"].level is Level.WARN
    assert shot.statuses["Path"].text == "The bag has no topic /plan. Choose another topic."
    assert capture(config, wait_for=["Scan"]).is_ok


def test_an_enabled_display_of_an_unsupported_class_is_not_ok(
    capture: Captures, tmp_path: Path
) -> None:
    file = tmp_path / "two.rviz"
    file.write_text("""\
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/Grid, Name: Grid, Enabled: true}
    - {Class: my_plugins/Laser, Name: Laser, Enabled: true}
    - {Class: my_plugins/Laser, Name: Spare, Enabled: false}
  Global Options: {Fixed Frame: odom}
""")
    shot: Capture = capture(file)
    assert not shot.is_ok
    assert shot.statuses.keys() == {"Grid", "Laser"}
    assert shot.statuses["Laser"].level is Level.ERROR
    assert "Unsupported display class my_plugins/Laser." in shot.statuses["Laser"].text
    assert not capture(file, wait_for=["Laser"]).is_ok
    assert capture(file, wait_for=["Grid"]).is_ok


def test_displays_of_one_name_are_numbered(capture: Captures) -> None:
    config = CONFIG + "- {type: Path, topic: /a}\n- {type: Path, topic: /b}\n"
    statuses = capture(config).statuses
    assert "/a" in statuses["Path"].text
    assert "/b" in statuses["Path (2)"].text


def test_a_config_can_be_a_file_a_text_or_a_config(capture: Captures, tmp_path: Path) -> None:
    file = tmp_path / "top.yaml"
    file.write_text(CONFIG)
    pictures = [capture(config).pixels for config in (CONFIG, file, str(file), parse(CONFIG, ""))]
    assert all((picture == pictures[0]).all() for picture in pictures)


def test_an_unknown_fixed_frame_is_reported(capture: Captures) -> None:
    shot: Capture = capture(CONFIG, fixed_frame="mapp")
    assert not shot.is_ok
    assert 'Did you mean "map"?' in shot.pictures[0].readiness.general["Fixed Frame"].text


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"at": 7.0}, "7 s is outside of"),
        ({"at": [1.0, "soon"]}, "'soon' is not a valid time"),
        ({"views": ["Farr"]}, "did you mean `Far`?"),
        ({"wait_for": ["Scam"]}, "No enabled display is named 'Scam': did you mean `Scan`?"),
        ({"size": (8, 240)}, "16 to 8192 pixels per side, not 8 x 240"),
        ({"focus": "bass"}, "bass"),
        ({"timeout": 1e-9, "at": 2.0}, "time-out passed after 0.0 s of 2.0 s"),
        ({"bag": "nowhere.mcap"}, "Bag nowhere.mcap not found"),
        ({"ros_args": ["--ros-args", "-p", "a:=1"]}, "'-p' is not supported with a bag"),
    ],
)
def test_invalid_options_are_refused_in_one_sentence(
    capture: Captures, options: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(webviz.Error) as excinfo:
        capture(CONFIG, **options)
    assert sentence in str(excinfo.value)
    assert "\n" not in str(excinfo.value)


@pytest.mark.parametrize(
    "displays", ["", "displays:\n- {type: Group, enabled: false, displays: [{type: Grid}]}\n"]
)
def test_a_config_that_shows_nothing_is_refused(capture: Captures, displays: str) -> None:
    with pytest.raises(webviz.Error, match="The config has no enabled display"):
        capture(f"fixed_frame: map\n{displays}")


def test_a_picture_waits_for_all_letters_of_labels(renderer: HeadlessRenderer) -> None:
    # viser makes the letters that are new for some milliseconds a frame.
    texts = tuple(chr(letter) * 2 for letter in range(0x3B1, 0x3C9))
    places = np.array([(i % 8 - 4, i // 8 - 2, 0) for i in range(len(texts))], np.float32)
    renderer.look(Orbit(distance=12.0))
    empty = renderer.capture()
    renderer.scene.upsert("labels", "letters", Labels(places, texts, 0.5))
    renderer.scene.flush()
    first = renderer.capture()
    renderer.page.draw(3 * len(texts))
    last = renderer.capture()
    renderer.clear()
    assert (last != empty).any(axis=2).sum() > 1000
    assert (first == last).all()


def test_a_topic_can_be_remapped(capture: Captures) -> None:
    config = CONFIG.replace("name: Scan", "name: Scan, topic: /front")
    assert not capture(config).is_ok
    assert capture(config, ros_args=["--ros-args", "-r", "/front:=/scan"]).is_ok


def test_a_notebook_can_make_pictures(run: Path) -> None:
    async def cell() -> Capture:
        return webviz.capture(CONFIG, bag=run, at=1.0, size=SIZE)

    with ThreadPoolExecutor(1) as notebook:
        shot = notebook.submit(asyncio.run, cell()).result()
    assert len(scan(shot.pixels)) > 20
