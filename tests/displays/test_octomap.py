"""The displays of octrees."""

from __future__ import annotations

import contextlib
import gc
import math
import random
from collections.abc import Callable
from itertools import product
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from mapping_scenes import hill, seen_from_above
from octrees import OCTOMAP, Key, OctreeNode, binary, full, octree, signed
from plain_scenes import in_moving_frame

from webviz.data.memory import DECODING, MemoryBudget
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.octomap import (
    ColorOccupancyGrid,
    OccupancyGrid,
    OccupancyGridStamped,
    OccupancyMap,
    OccupancyMapStamped,
)
from webviz_displays.octomap import octree as octree_module
from webviz_displays.octomap import projection as projection_module
from webviz_displays.octomap import visible_voxels as visible_voxels_module
from webviz_displays.octomap.octree import Octree, OctreeFault, read_octree
from webviz_displays.octomap.voxels import is_exposed, voxels_of

Form = Callable[..., dict[str, Any]]
CUBE: list[Key] = list(product(range(-2, 2), range(-2, 2), range(-2, 2)))
FORMS = pytest.mark.parametrize("form", [binary, full])


def read(values: dict[str, Any]) -> Octree:
    return read_octree(SimpleNamespace(**values | {"data": np.array(values["data"], np.int8)}))


def some_keys(count: int) -> set[Key]:
    """Keys in a small space, so that many are neighbours."""
    rng = random.Random(0)
    return {(rng.randint(-9, 9), rng.randint(-9, 9), rng.randint(-9, 9)) for _ in range(count)}


@FORMS
def test_voxels_are_read_where_they_were_written(form: Form) -> None:
    keys = some_keys(3000) | {(-(1 << 15), 0, 5), ((1 << 15) - 1, -(1 << 15), 7)}
    tree = read(form(octree(keys), 0.25))
    voxels = voxels_of(tree, 16)
    assert set(map(tuple, np.floor(voxels.centers / 0.25).astype(int).tolist())) == keys
    assert set(voxels.sizes) == {0.25}
    assert (tree.log_odds == 3.5).all()


@FORMS
def test_a_leaf_above_the_last_level_is_a_large_voxel(form: Form) -> None:
    root = octree([(0, 0, 0)])
    root.place((1, -1, 0), depth=14, log_odds=-2.0)
    tree = read(form(root, 0.5))
    voxels = voxels_of(tree, 16)
    centers = dict(zip(voxels.sizes.tolist(), map(tuple, voxels.centers.tolist()), strict=True))
    assert centers == {0.5: (0.25, 0.25, 0.25), 2.0: (3.0, -1.0, 1.0)}
    assert sorted(tree.log_odds[voxels.nodes].tolist()) == [-2.0, 3.5]


@FORMS
def test_a_truncated_node_is_as_occupied_as_its_most_occupied_child(form: Form) -> None:
    root = octree([(0, 0, 0), (5, 5, 5)], -2.0)
    root.place((1, 0, 0), log_odds=3.5)
    tree = read(form(root, 1.0))
    voxels = voxels_of(tree, 15)
    log_odds = dict(zip(voxels.centers[:, 0].tolist(), tree.log_odds[voxels.nodes], strict=True))
    assert log_odds == {1.0: 3.5, 5.0: -2.0}
    assert set(voxels.sizes) == {2.0}


def test_a_voxel_is_hidden_only_if_the_others_cover_all_its_sides() -> None:
    """Compared with the neighbours one by one; a large voxel covers small ones and the reverse."""
    keys = some_keys(5500)
    root = octree(keys)
    root.place((6, 0, 0), depth=14, log_odds=3.5)
    large = set(product(range(24, 28), range(4), range(4)))
    beside = {(23, y, z) for y, z in product(range(4), repeat=2)} | {(28, 1, 1)}
    for key in beside:
        root.place(key, log_odds=3.5)
    tree = read(full(root, 1.0))
    voxels = voxels_of(tree, 16)
    exposed = is_exposed(tree, voxels)
    solid = keys | large | beside
    for center, size, is_seen in zip(voxels.centers, voxels.sizes, exposed, strict=True):
        x, y, z = np.floor(center).astype(int).tolist()
        around = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
        if size == 1.0:
            assert is_seen != all((x + a, y + b, z + c) in solid for a, b, c in around)
        else:
            assert is_seen


@FORMS
def test_occupied_voxels_are_boxes_in_the_frame_of_the_tree(turned: Callable, form: Form) -> None:
    root = octree(CUBE)
    root.place((0, 0, 5), log_odds=-2.0)
    at = turned(OccupancyGrid(), form(root, 0.5))
    node = at.nodes()["voxels"]
    assert (node.shape, len(node.positions)) == ("box", 4**3 - 2**3)
    np.testing.assert_allclose(node.scales, 0.5)
    low, high = at.xyz("voxels").min(axis=0), at.xyz("voxels").max(axis=0)
    np.testing.assert_allclose((low, high), ((9.25, -0.75, -0.75), (10.75, 0.75, 0.75)), atol=1e-6)
    statuses = at.statuses()
    assert statuses["Voxels"] == ("OK", "Showing 56 occupied voxels; they enclose 8 more.")
    assert statuses["Octree"][1].startswith("OcTree of ")
    at.set("voxel_rendering", "Free Voxels")
    assert at.xyz("voxels").tolist() == pytest.approx(np.array([[9.75, 0.25, 2.75]]))
    at.set("voxel_rendering", "All Voxels")
    assert len(at.nodes()["voxels"].positions) == 57


def test_depth_and_heights_limit_the_voxels(turned: Callable) -> None:
    at = turned(OccupancyGrid(max_octree_depth=15), full(octree(CUBE), 1.0))
    assert at.nodes()["voxels"].scales.tolist() == [[2.0] * 3] * 8
    at.set("max_octree_depth", 0)
    assert len(at.nodes()["voxels"].positions) == 56
    at.set("min_height", 0.0)
    at.set("max_height", 1.0)
    assert {z for _, _, z in at.xyz("voxels").tolist()} == {0.5}
    assert len(at.nodes()["voxels"].positions) == 16
    at.set("min_height", 0.75)
    assert at.nodes() == {}
    assert at.statuses()["Voxels"][0] == "WARN"


def test_colors_are_by_height_probability_or_of_the_cells(turned: Callable) -> None:
    root = OctreeNode()
    root.place((0, 0, 0), log_odds=0.0, color=(1, 2, 3))
    root.place((0, 0, 1), log_odds=100.0, color=(4, 5, 6))
    at = turned(ColorOccupancyGrid(voxel_coloring="Cell Color"), full(root, 1.0, "ColorOcTree"))
    assert at.nodes()["voxels"].colors.tolist() == [[1, 2, 3], [4, 5, 6]]
    at.set("voxel_coloring", "Cell Probability")
    assert at.nodes()["voxels"].colors.tolist() == [[128, 128, 0], [0, 255, 0]]
    at.set("voxel_coloring", "Z-Axis")  # hues 216° and 72°, at a quarter and three quarters
    assert at.nodes()["voxels"].colors.tolist() == [[0, 102, 255], [204, 255, 0]]
    at.set("voxel_coloring", "Cell Color")
    at.send(OCTOMAP, full(root, 1.0), frame="odom")
    at.turn()
    assert at.statuses()["Colors"][0] == "WARN"
    assert at.nodes()["voxels"].colors.tolist() == [[0, 102, 255], [204, 255, 0]]
    at.press("Colors")


@pytest.mark.parametrize(
    "properties",
    [{"voxel_rendering": "Free Voxels"}, {"min_height": 90.0}, {"max_height": -90.0}],
)
def test_the_button_of_voxels_that_are_not_shown_shows_some(
    turned: Callable, properties: dict[str, Any]
) -> None:
    root = OctreeNode()
    root.place((0, 0, 0), log_odds=1.0)
    at = turned(OccupancyGrid(**properties), full(root, 1.0))
    assert at.nodes() == {}
    at.press("Voxels")
    assert at.nodes()


def test_too_many_voxels_are_merged(turned: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(visible_voxels_module, "MAX_VOXELS", 50)
    at = turned(OccupancyGrid(), binary(octree(CUBE), 1.0))
    assert at.nodes()["voxels"].scales.tolist() == [[2.0] * 3] * 8
    level, text = at.statuses()["Voxels"]
    assert level == "WARN"
    assert "below depth 15" in text
    at.press("Voxels")
    assert at.nodes()["voxels"].scales.tolist() == [[2.0] * 3] * 8


def test_a_map_of_too_many_cells_offers_the_depth_that_fits(
    turned: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(projection_module, "MAX_CELLS", 4)
    tree = binary(octree(CUBE), 1.0)
    at = turned(OccupancyMap(), tree)
    assert "Lower Max. Octree Depth." in at.statuses()["Map"][1]
    remedy = at.remedy("Map")
    at.set(remedy.path, remedy.value)
    at.send(OCTOMAP, tree, frame="odom")
    at.turn()
    assert at.statuses()["Map"][0] == "OK"


def chain(length: int) -> dict[str, Any]:
    """A full tree that is as deep as it is long."""
    node = OctreeNode()
    for _ in range(length):
        node = OctreeNode(children={0: node})
    return full(node)


WHOLE = full(octree(CUBE))
FAULTS = {
    "nothing": ({**WHOLE, "data": []}, "The tree is empty: the message"),
    "a root": (full(OctreeNode()), "The tree is empty: it has no node"),
    "a binary root": (binary(OctreeNode()), "The tree is empty: it has no node"),
    "half": ({**WHOLE, "data": WHOLE["data"][:-1]}, "ends inside"),
    "binary half": ({**binary(octree(CUBE)), "data": [-1, -1] * 10}, "ends inside"),
    "deep": (chain(17), "deeper than 16"),
    "very deep": ({**WHOLE, "data": signed(b"\0\0\0\0\xff" * 1000 + b"\0" * 50_000)}, "deeper"),
    "a kind": ({**WHOLE, "id": "CountingOcTree"}, "Trees of type 'CountingOcTree'"),
    "no size": ({**WHOLE, "resolution": 0.0}, "The resolution is 0 m"),
    "no number": ({**WHOLE, "resolution": math.nan}, "The resolution is nan m"),
    "huge": ({**WHOLE, "resolution": 1e300}, "The resolution is 1e+300 m"),
}


@pytest.mark.parametrize("case", FAULTS)
def test_an_undecodable_tree_has_a_status(turned: Callable, case: str) -> None:
    values, reason = FAULTS[case]
    at = turned(OccupancyGrid(), values)
    assert at.nodes() == {}
    level, text = at.statuses()["Octree"]
    assert level == "ERROR"
    assert reason in text


def test_a_tree_of_too_many_nodes_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(octree_module, "MAX_NODES", 50)
    for form in (binary, full):
        with pytest.raises(OctreeFault, match="The tree has more than"):
            read(form(octree(CUBE)))


@FORMS
def test_nodes_are_counted_before_a_tree_is_read(
    form: Form, monkeypatch: pytest.MonkeyPatch
) -> None:
    values = form(octree(some_keys(100)))
    message = SimpleNamespace(**values | {"data": np.array(values["data"], np.int8)})
    budget = MemoryBudget(1 << 30)
    monkeypatch.setattr(octree_module, "DECODING", budget)
    monkeypatch.setattr(octree_module, "SLOW_BYTES", 0)
    size = len(read_octree(message).codes) * octree_module.NODE_BYTES
    for total, is_enough in ((size, True), (size - 1, False)):
        budget.total = total
        with (
            contextlib.nullcontext() if is_enough else pytest.raises(OctreeFault, match="takes"),
            octree_module.memory_for(message),
        ):
            pass


LARGE = full(octree(some_keys(6000)))
"""Read in a worker."""


def test_a_tree_that_takes_more_memory_than_there_is_is_refused(
    turned: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(octree_module, "NODE_BYTES", DECODING.total)
    level, text = turned(OccupancyGrid(), LARGE).statuses()["Octree"]
    assert (level, "to decode; the limit is" in text) == ("ERROR", True), text


def test_trees_are_held_in_memory_as_long_as_there_is_some_for_them(turned: Callable) -> None:
    class Robot:
        """Something large that is loaded."""

    robot = Robot()
    DECODING.hold(robot, DECODING.room - DECODING.least_room)
    at = turned(OccupancyGrid(), LARGE)
    level, text = at.statuses()["Octree"]
    assert (level, "0 MB of 450 MB are left. Publish a part" in text) == ("ERROR", True), text
    del robot
    gc.collect()
    at.set("voxel_alpha", 0.5)
    at.settle()
    assert at.statuses()["Octree"][0] == "OK"
    assert at.nodes()


def cells(at: DisplayBench) -> list[list[int]]:
    """The values of a map of one tile, the row with the lowest y first."""
    return at.nodes()["tile 0 0"].cells.view(np.int8).tolist()


def test_an_octree_from_above_is_occupied_where_any_voxel_is(bench: Benches) -> None:
    root = OctreeNode()
    root.place((2, 1, 0), depth=15, log_odds=-2.0)  # two cells wide, from 4, 2
    root.place((4, 2, 7), log_odds=3.5)
    root.place((4, 4, -9), log_odds=3.5)
    root.place((7, 4, 0), log_odds=-2.0)
    at = bench(OccupancyMap())
    at.send(OCTOMAP, binary(root, 0.5), frame="map", topic="/octomap_binary")
    at.turn()
    assert cells(at) == [[100, 0, -1, -1], [0, 0, -1, -1], [100, -1, -1, 0]]
    assert at.poses()["tile 0 0"].position == (2.0, 1.0, 0.0)
    assert at.statuses()["Map"] == ("OK", "4 x 3 cells of 0.5 m in frame 'map'.")
    at.set("max_octree_depth", 15)
    at.send(OCTOMAP, full(root, 0.5), frame="map", topic="/octomap_binary")
    at.turn()
    assert cells(at) == [[100, -1], [100, 0]]
    at.send(OCTOMAP, {**WHOLE, "data": []}, frame="map", topic="/octomap_binary")
    at.turn()
    assert at.statuses()["Map"][1].startswith("The tree is empty")
    far = octree([(-30_000, -30_000, 0), (30_000, 30_000, 0)])
    at.set("max_octree_depth", 16)
    at.send(OCTOMAP, binary(far), frame="map", topic="/octomap_binary")
    at.turn()
    assert at.statuses()["Map"][1].startswith("The map would have 60001 x 60001 cells")


def test_any_bytes_are_a_tree_or_a_fault() -> None:
    rng = np.random.default_rng(0)
    for kind, is_binary in product(("OcTree", "ColorOcTree"), (False, True)):
        for _ in range(200):
            data = rng.integers(-128, 128, 400).astype(np.int8)
            data[rng.random(400) < rng.random()] = 0
            values = {"id": kind, "binary": is_binary, "resolution": 0.1, "data": data}
            try:
                tree = read(values)
            except OctreeFault:
                continue
            voxels = voxels_of(tree, 16)
            assert np.isfinite(voxels.centers).all()
            is_exposed(tree, voxels)


@pytest.mark.parametrize("kind", [OccupancyGrid, OccupancyMap])
def test_a_dense_tree_is_read_beside_the_frame_loop(bench: Benches, kind: Any) -> None:
    rng = np.random.default_rng(0)
    keys: list[Key] = [(x, y, z) for x, y, z in rng.integers(-40, 40, (20_000, 3)).tolist()]
    at = bench(kind())
    at.transform("map", "odom")
    at.send(OCTOMAP, binary(octree(keys), 0.1), frame="odom")
    at.turn()
    assert at.nodes() == {}
    assert at.runner.is_busy()
    at.settle()
    assert at.nodes()


class TestColorOccupancyGrid(BuiltInChecks):
    display = ColorOccupancyGrid
    messages: ClassVar = {}
    scene = in_moving_frame(OCTOMAP, hill("ColorOcTree"))
    needs: ClassVar = {"max_height": {"max_height": 0.3}, "min_height": {"min_height": 0.3}}


class TestOccupancyGrid(BuiltInChecks):
    display = OccupancyGrid
    scene = in_moving_frame(OCTOMAP, hill("ColorOcTree"))
    needs: ClassVar = {"max_height": {"max_height": 0.3}, "min_height": {"min_height": 0.3}}


class TestOccupancyGridStamped(BuiltInChecks):
    display = OccupancyGridStamped
    messages: ClassVar = {}
    scene = in_moving_frame(OCTOMAP, hill("ColorOcTree"))
    needs: ClassVar = {"max_height": {"max_height": 0.3}, "min_height": {"min_height": 0.3}}


class TestOccupancyMap(BuiltInChecks):
    display = OccupancyMap
    scene = seen_from_above
    later = ("max_octree_depth",)


class TestOccupancyMapStamped(BuiltInChecks):
    display = OccupancyMapStamped
    messages: ClassVar = {}
    scene = seen_from_above
    later = ("max_octree_depth",)


def test_selecting_voxel_of_an_octree(bench: Benches) -> None:
    """The one on top, which is the last along the curve through the tree."""
    at = bench(ColorOccupancyGrid())
    at.transform("map", "odom")
    at.send(OCTOMAP, hill("ColorOcTree"), frame="odom")
    at.turn()
    check_details(
        at.pick("voxels", 4),
        "Occupied voxel",
        {
            "Occupancy": "62.2%",
            "Log-odds": "0.5",
            "Size": "0.5 m",
            "Depth": "16",
            "Color": "r 0, g 255, b 0",
        },
    )
