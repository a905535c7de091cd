"""The display of the clouds that RTAB-Map has collected."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
import photos
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from plain_scenes import in_moving_frame
from rtabmap_scenes import (
    BOTH,
    MAP_DATA,
    MAPPED,
    SCAN,
    float_png,
    map_data,
    millimetres,
    rgbd,
    scanned,
)
from waiting import until

from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.map_cloud import MapCloud, known_map
from webviz_displays.map_cloud.compression import RVL

FAR = np.full((6, 8), 2.0, np.float32)
RED = np.full((6, 8, 3), (200, 30, 20), np.uint8)
HERE = {1: (0.0, 0.0)}


@pytest.fixture
def cloud_bench(bench: Benches) -> Callable[..., Any]:
    """A bench that has drawn messages in the frame odom, 10 m along x."""

    def make(*messages: dict[str, Any], **properties: Any) -> DisplayBench:
        at = bench(MapCloud(**({"cloud_decimation": 1, "cloud_voxel_size": 0.0} | properties)))
        at.transform("map", "odom", (10.0, 0.0, 0.0))
        for values in messages:
            publish(at, values)
        return at

    return make


def publish(at: DisplayBench, values: dict[str, Any]) -> None:
    at.send(MAP_DATA, values, frame="odom", topic="/rtabmap/mapData")
    at.turn()
    until(lambda: not at.runner.is_busy(), turn=at.turn)


def points(at: DisplayBench) -> np.ndarray:
    """The points of all nodes in the fixed frame."""
    return np.concatenate([at.xyz(key) for key in at.nodes()])


@pytest.mark.parametrize("pack", [millimetres, float_png])
def test_pixels_are_ahead_of_the_camera_of_their_node(cloud_bench: Callable, pack: Any) -> None:
    at = cloud_bench(map_data({1: (1.0, 0.0)}, {1: rgbd(RED, FAR, pack)}))
    xyz = points(at)
    np.testing.assert_allclose(xyz[:, 0], 13.0, atol=1e-5)
    np.testing.assert_allclose([xyz[:, 1].min(), xyz[:, 1].max()], (-0.875, 0.875), atol=1e-5)
    np.testing.assert_allclose([xyz[:, 2].min(), xyz[:, 2].max()], (-0.625, 0.625), atol=1e-5)
    (node,) = at.nodes().values()
    np.testing.assert_allclose(node.colors.mean(0), (200, 30, 20), atol=3)
    assert at.statuses()["Points"] == ("OK", "48 points of 1 node.")


def test_images_of_several_cameras_are_beside_each_other(cloud_bench: Callable) -> None:
    aside = {"translation": {"y": 5.0}, "rotation": {"w": 1.0}}
    one = rgbd(RED, FAR)
    both = {
        "left_compressed": photos.jpeg(np.hstack((RED, 255 - RED)))["data"],
        "right_compressed": millimetres(np.hstack((FAR, 2 * FAR))),
        "left_camera_info": 2 * one["left_camera_info"],
        "local_transform": [*one["local_transform"], aside],
    }
    at = cloud_bench(map_data(HERE, {1: both}))
    (node,) = at.nodes().values()
    np.testing.assert_allclose(points(at)[48:, 2], 4.0, atol=1e-5)
    assert node.colors[:48, 0].min() > 150 > 100 > node.colors[48:, 0].max()


def test_a_new_graph_moves_the_clouds_without_sending_them_again(cloud_bench: Callable) -> None:
    at = cloud_bench(map_data(HERE, {1: rgbd(RED, FAR)}))
    (before,) = at.nodes().values()
    publish(at, map_data({1: (0.0, 7.0)}, {}))
    (after,) = at.nodes().values()
    assert after == before
    np.testing.assert_allclose(points(at)[:, 1].mean(), 7.0, atol=1e-5)
    publish(at, map_data({2: (0.0, 0.0)}, {}))
    assert at.nodes() == {}, "the node has left the graph"


def test_scans_have_colours_of_their_intensities(cloud_bench: Callable) -> None:
    at = cloud_bench(map_data(HERE, {1: scanned(*SCAN)}), cloud_from_scan=True)
    np.testing.assert_allclose(points(at)[1], (12.0, 1.0, 1.0), atol=1e-6)
    (node,) = at.nodes().values()
    assert node.colors[:2].tolist() == [[255, 0, 0], [255, 0, 255]]
    flat = scanned(*((x, y) for x, y, *_ in SCAN), format=1)
    publish(at, map_data(HERE, {1: flat}))
    np.testing.assert_allclose(points(at)[:, 2], 0.5, atol=1e-6)


@pytest.mark.parametrize(
    ("properties", "count"),
    [
        ({"cloud_decimation": 2}, 12),
        ({"cloud_max_depth": 1.5}, 24),
        ({"cloud_min_depth": 1.5}, 24),
        ({"cloud_voxel_size": 1.0}, 4),
        ({"filter_floor": 0.01}, 24),
        ({"filter_ceiling": -0.01}, 24),
        ({"cloud_max_depth": 0.0}, 48),
    ],
)
def test_points_are_filtered_as_they_arrive(
    properties: dict[str, Any], count: int, cloud_bench: Callable
) -> None:
    depths = FAR.copy()
    depths[:3] = 1.0
    at = cloud_bench(map_data(HERE, {1: rgbd(RED, depths)}), **properties)
    assert len(points(at)) == count


def test_near_nodes_that_look_the_same_way_are_filtered(cloud_bench: Callable) -> None:
    places = {1: (0.0, 0.0), 2: (0.5, 0.0), 3: (3.0, 0.0)}
    at = cloud_bench(map_data(places, dict.fromkeys(places, rgbd(RED, FAR))))
    assert len(points(at)) == 3 * 48
    at.set("node_filtering_radius", 1.0)
    assert sorted({round(x) for x in points(at)[:, 0]}) == [12, 15], "the newer one stays"
    at.set("node_filtering_angle", 0.0)
    assert len(points(at)) == 3 * 48


def test_earlier_data_is_requested_until_it_arrives(cloud_bench: Callable) -> None:
    places = {-4: (0.0, 0.0), 1: (0.0, 0.0), 2: (1.0, 0.0)}
    at = cloud_bench(map_data(places, {2: BOTH}), download_namespace="/rtabmap")
    at.turn()
    ((advertisement, message),) = at.graph.published
    assert advertisement.topic == "/rtabmap/republish_node_data"
    assert message.data.tolist() == [1], "neither what came nor a landmark"
    sentence = "1 node asked for on /rtabmap/republish_node_data."
    assert at.statuses()["Nodes"] == ("OK", sentence)
    publish(at, map_data({1: (0.0, 0.0), 2: (1.0, 0.0)}, {1: BOTH}))
    at.turn()
    assert len(at.graph.published) == 1
    assert "Nodes" not in at.statuses()


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        ({"right_camera_info": [{}]}, "it has stereo images instead of depths"),
        ({"local_transform": []}, "it has 1 camera infos for 0 transforms of cameras"),
        ({"left_camera_info": [{}]}, "The camera is not calibrated"),
        ({"right_compressed": [1, 2, 3]}, "image"),
        ({"right_compressed": np.frombuffer(RVL + b"\1", np.uint8)}, "The RVL image has no header"),
        ({"left_compressed": [255, 216, 255]}, "The JPEG is damaged"),
    ],
)
def test_a_node_with_invalid_data_is_named_and_the_others_stay(
    data: dict[str, Any], reason: str, cloud_bench: Callable
) -> None:
    good = rgbd(RED, FAR)
    at = cloud_bench(map_data({7: (0.0, 0.0), 8: (1.0, 0.0)}, {7: good | data, 8: good}))
    assert len(points(at)) == 48
    level, text = at.statuses()["Nodes"]
    assert (level, text.startswith("Node 7 is left out: ")) == ("WARN", True)
    assert reason in text


@pytest.mark.parametrize(
    "scan",
    [
        {"laser_scan_format": 99},
        {"laser_scan_format": 12},
        {"laser_scan_compressed": [1, 2]},
        {"laser_scan_compressed": np.frombuffer(bytes(12), np.uint8)},
        {
            "laser_scan_compressed": np.frombuffer(
                b"xx" + bytes([1, 0, 0, 0] * 2) + b"\5\0\0\0", "B"
            )
        },
    ],
)
def test_an_invalid_scan_is_named(scan: dict[str, Any], cloud_bench: Callable) -> None:
    at = cloud_bench(map_data(HERE, {1: scanned(*SCAN) | scan}), cloud_from_scan=True)
    assert at.nodes() == {}
    assert at.statuses()["Nodes"][1].startswith("Node 1 is left out: ")


def test_colours_that_the_data_lack_are_chosen_by_the_data(cloud_bench: Callable) -> None:
    at = cloud_bench(map_data(HERE, {1: rgbd(RED, FAR)}), color_transformer="Intensity")
    assert at.statuses()["Colors"][0] == "WARN"
    at.press("Colors")
    at = cloud_bench(
        map_data(HERE, {1: scanned(*SCAN)}), cloud_from_scan=True, color_transformer="RGB8"
    )
    assert at.statuses()["Colors"][0] == "WARN"
    at.press("Colors")


def test_nodes_without_the_selected_data_are_named(cloud_bench: Callable) -> None:
    at = cloud_bench(map_data(HERE, {1: rgbd(RED, FAR)}), cloud_from_scan=True)
    sentence = "The nodes have no laser scans. Change Cloud from scan."
    assert at.statuses()["Points"] == ("WARN", sentence)


def test_too_many_points_are_dropped_or_thinned_with_a_word(
    cloud_bench: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    at = cloud_bench(MAPPED, style="Boxes")
    total = len(points(at))
    monkeypatch.setattr("webviz_displays.map_cloud.DOTS_LIMIT", total // 3)
    at.set("style", "Points")
    assert at.statuses()["Points"] == ("OK", f"{total // 4} points of 2 nodes, one of 4.")
    monkeypatch.setattr(known_map, "MAX_POINTS", total - 1)
    sentence = (
        "1 node left out: the map has too many points. "
        "Increase Cloud Decimation or Cloud Voxel Size."
    )
    assert cloud_bench(MAPPED).statuses()["Nodes"] == ("WARN", sentence)


class TestMapCloud(BuiltInChecks):
    display = MapCloud
    scene = in_moving_frame(MAP_DATA, MAPPED)
    variants = (
        MapCloud,
        lambda: MapCloud(cloud_from_scan=True),
    )
    later = ("decay_time", "cloud_decimation", "cloud_from_scan")
    elsewhere = (
        "cloud_max_depth",
        "cloud_min_depth",
        "cloud_voxel_size",
        "download_namespace",
        "filter_ceiling",
        "filter_floor",
        "node_filtering_angle",
        "node_filtering_radius",
    )
    needs: ClassVar = {
        "autocompute_intensity_bounds": {"color_transformer": "Intensity", "cloud_from_scan": True},
        "invert_rainbow": {"color_transformer": "Intensity", "cloud_from_scan": True},
        "min_color": {"color_transformer": "Intensity", "cloud_from_scan": True},
        "min_intensity": {"color_transformer": "Intensity", "cloud_from_scan": True},
        "max_color": {"color_transformer": "Intensity", "cloud_from_scan": True},
        "max_intensity": {"color_transformer": "Intensity", "cloud_from_scan": True},
    }


def test_selecting_point_of_a_map(bench: Benches) -> None:
    """The second of the second node; the first has left the graph."""
    at = bench(MapCloud(cloud_from_scan=True))
    data = {id: scanned(*SCAN) for id in (3, 5)}
    for places in ({3: (0.0, 0.0), 5: (1.0, 0.0)}, {5: (1.0, 0.0)}):
        at.send(MAP_DATA, map_data(places, data), frame="map", topic="/rtabmap/mapData")
        at.turn()
    check_details(
        at.pick("points", 1),
        "Point of node 5",
        {"Seen": "500.000 s", "Points of the node": "3", "Intensity": "90.0"},
    )
