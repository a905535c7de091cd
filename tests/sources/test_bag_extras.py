"""Sources beside a bag."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import PIL.Image
import pytest
from bags import strings

from tests.sources.conftest import PlayedBag
from webviz.api.declared import Topic
from webviz.data.messages import OccupancyGrid, TFMessage, decode
from webviz.sources import Subscription
from webviz.sources.bag.extras import ExtraError, map_of_file, static_transform


def write_map(folder: Path) -> Path:
    pixels = np.array([[255, 0, 205], [0, 255, 255]], np.uint8)
    PIL.Image.fromarray(pixels).save(folder / "lab.png")
    path = folder / "lab.yaml"
    path.write_text(
        "image: lab.png\nresolution: 0.5\norigin: [1.0, -2.0, 0.5]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    return path


def test_a_map_of_a_file_is_that_of_map_server(tmp_path: Path) -> None:
    extra = map_of_file(write_map(tmp_path))
    grid: OccupancyGrid = decode(extra.type, extra.cdr)
    assert (extra.topic, grid.header.frame_id) == ("/map", "map")
    assert (grid.info.width, grid.info.height, grid.info.resolution) == (3, 2, 0.5)
    assert grid.data.tolist() == [100, 0, 0, 0, 100, -1]
    position, orientation = grid.info.origin.position, grid.info.origin.orientation
    assert (position.x, position.y) == (1.0, -2.0)
    assert 2 * math.atan2(orientation.z, orientation.w) == pytest.approx(0.5)


def test_a_static_transform_has_the_pose_of_the_child() -> None:
    extra = static_transform("map", "odom", 1.0, -2.0, math.pi / 2, 3.0)
    message: TFMessage = decode(extra.type, extra.cdr)
    (transform,) = message.transforms
    assert (transform.parent, transform.child) == ("map", "odom")
    assert tuple(transform.translation) == (1.0, -2.0, 3.0)
    assert tuple(transform.rotation) == pytest.approx((0, 0, math.sqrt(0.5), math.sqrt(0.5)))


def test_extras_arrive_at_the_start(tmp_path: Path, open_bag: Callable[..., PlayedBag]) -> None:
    extra = map_of_file(write_map(tmp_path))
    source = open_bag(strings(0, 1).write(tmp_path / "bag"), [extra]).source
    (publisher,) = source.offers()["/map"].publishers
    assert (publisher.node, publisher.durability) == ("the map lab.yaml", "transient_local")
    source.want({"/map": Subscription(extra.type, Topic("/map"))})
    source.play_until(source.history.start_ns)
    (raw,) = source.inbox.drain()["/map"]
    assert (raw.cdr, raw.received_ns) == (extra.cdr, source.history.start_ns)


@pytest.mark.parametrize(
    ("parent", "child", "x"), [("map", "map", 0.0), ("", "odom", 0.0), ("map", "odom", math.nan)]
)
def test_an_invalid_transform_is_refused(parent: str, child: str, x: float) -> None:
    with pytest.raises(ExtraError):
        static_transform(parent, child, x, 0.0)


def test_a_map_that_is_missing_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ExtraError, match=r"nowhere\.yaml"):
        map_of_file(tmp_path / "nowhere.yaml")
