"""The displays of nvblox: maps of which messages bring the blocks that have changed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from mapping_scenes import MESH, VOXELS
from plain_scenes import in_moving_frame

from webviz.shell.testing import check_details
from webviz_displays import nvblox
from webviz_displays.nvblox import NvbloxMesh, NvbloxVoxelBlockLayer

TYPES = {
    NvbloxMesh: "nvblox_msgs/msg/Mesh",
    NvbloxVoxelBlockLayer: "nvblox_msgs/msg/VoxelBlockLayer",
}
NEAR, FAR = "region 0 0 0", "region 1 0 0"


def block(x: int, part: dict[str, Any], **fields: Any) -> dict[str, Any]:
    """A message with one block."""
    return {**MESH, "block_indices": [{"x": x}], "blocks": [part], **fields}


def test_surfaces_have_the_colours_of_their_corners(display_bench: Callable) -> None:
    at = display_bench(NvbloxMesh(), MESH)
    near, far = at.nodes()[NEAR], at.nodes()[FAR]
    assert near.faces.tolist() == [[0, 1, 2], [3, 4, 5]]
    np.testing.assert_allclose(at.xyz(NEAR)[1], (10.8, 0.0, 0.1), atol=1e-6)
    assert near.colors[:3].tolist() == [[255, 0, 0, 255], [0, 128, 0, 255], [0, 0, 255, 255]]
    assert far.colors[:, :3].tolist() == [[nvblox.GREY] * 3] * 3
    assert at.statuses()["Blocks"] == ("OK", "3 triangles in 3 blocks of 0.8 m.")


def test_voxels_are_boxes_of_their_size(display_bench: Callable) -> None:
    at = display_bench(NvbloxVoxelBlockLayer(), VOXELS)
    node = at.nodes()[NEAR]
    np.testing.assert_allclose(at.xyz(NEAR)[1], (10.8, 0.0, 0.1), atol=1e-6)
    np.testing.assert_allclose(node.scales, 0.1)
    assert node.colors[:2].tolist() == [[255, 0, 0], [0, 128, 0]]
    assert at.statuses()["Blocks"] == ("OK", "9 voxels in 3 blocks of 0.8 m.")


def test_a_message_changes_its_own_blocks_only(display_bench: Callable) -> None:
    triangle, mesh = MESH["blocks"][0], TYPES[NvbloxMesh]
    at = display_bench(NvbloxMesh(), MESH)
    far = at.nodes()[FAR]

    def publish(values: dict[str, Any]) -> dict[str, Any]:
        at.send(mesh, values, frame="odom")
        at.turn()
        return at.nodes()

    nodes = publish(block(2, triangle))
    assert (len(nodes[NEAR].faces), nodes[NEAR].faces.max()) == (3, 8)
    assert nodes[FAR] is far
    assert len(publish(block(2, {}))[NEAR].faces) == 2, "an empty block is removed"
    assert set(publish(block(5, triangle, clear=True))) == {FAR}, "clear removes all others"
    assert publish({"block_size_m": 0.8, "clear": True}) == {}
    assert at.statuses()["Blocks"] == ("WARN", "The map is empty.")


@pytest.mark.parametrize(("cls", "values"), [(NvbloxMesh, MESH), (NvbloxVoxelBlockLayer, VOXELS)])
def test_the_ceiling_is_cut_by_blocks(
    cls: Any, values: dict[str, Any], display_bench: Callable
) -> None:
    at = display_bench(cls(cut_ceiling=True), values)
    assert set(at.nodes()) == {NEAR}
    at.set("ceiling_height", 1.7)
    assert set(at.nodes()) == {NEAR, FAR}
    at.set("ceiling_height", -1.0)
    assert at.nodes() == {}
    sentence = "All blocks are above Ceiling Height. Raise it."
    assert at.statuses()["Blocks"] == ("WARN", sentence)
    at.press("Blocks")
    assert set(at.nodes()) == {NEAR, FAR}


@pytest.mark.parametrize(
    ("part", "reason"),
    [
        ({"triangles": [0, 1, 3]}, "a triangle has a corner besides its 3 vertices"),
        ({"triangles": [0, 1, -1]}, "a triangle has a corner besides its 3 vertices"),
        ({"triangles": [0, 1]}, "its 2 corners of triangles are not a multiple of 3"),
        ({"colors": [{"r": 1.0}]}, "it has 3 points, but 1 colours"),
        ({"vertices": [{"x": float("nan")}] * 3}, "a point is not finite or farther than 1e9 m"),
    ],
)
def test_an_invalid_block_is_named_and_the_others_stay(
    part: dict[str, Any], reason: str, display_bench: Callable
) -> None:
    bad = {**MESH["blocks"][0], **part}
    at = display_bench(NvbloxMesh(), {**MESH, "blocks": [bad, *MESH["blocks"][1:]]})
    assert len(at.nodes()[NEAR].faces) == 1
    sentence = f"Block 0 0 0 is left out: {reason}. Fix the publisher."
    assert at.statuses()["Blocks"] == ("WARN", sentence)


def test_invalid_voxel_sizes_are_refused(display_bench: Callable) -> None:
    at = display_bench(NvbloxVoxelBlockLayer(), {**VOXELS, "voxel_size_m": float("nan")})
    assert at.nodes() == {}
    assert at.statuses()["Blocks"] == ("ERROR", "voxel_size_m is nan. Fix the publisher.")


def test_too_large_maps_are_cut_with_a_warning(
    display_bench: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(NvbloxVoxelBlockLayer, "most", 6)
    at = display_bench(NvbloxVoxelBlockLayer(), VOXELS)
    assert set(at.nodes()) == {NEAR}
    assert at.statuses()["Blocks"] == ("WARN", "Showing 6 of 9 voxels.")
    monkeypatch.setattr(nvblox, "MAX_POINTS", 6)
    at = display_bench(NvbloxVoxelBlockLayer(), VOXELS)
    sentence = "1 block left out: the map is too large. Send it with clear set."
    assert at.statuses()["Blocks"] == ("WARN", sentence)


class TestNvbloxMesh(BuiltInChecks):
    display = NvbloxMesh
    scene = in_moving_frame("nvblox_msgs/msg/Mesh", MESH)


class TestNvbloxVoxelBlockLayer(BuiltInChecks):
    display = NvbloxVoxelBlockLayer
    scene = in_moving_frame("nvblox_msgs/msg/VoxelBlockLayer", VOXELS)


def test_selecting_voxel_of_nvblox(turned: Benches) -> None:
    check_details(
        turned(NvbloxVoxelBlockLayer(), VOXELS).pick("region 0 0 0", 1),
        "Voxel",
        {"Edge": "0.1 m"},
    )


def test_selecting_surface_of_nvblox(bench: Benches) -> None:
    at = bench(NvbloxMesh())
    at.send("nvblox_msgs/msg/Mesh", MESH, frame="map", topic="/nvblox_node/mesh")
    at.turn()
    check_details(at.pick("region 0 0 0", None, (0.1, 0.1, 0.1)), "Mesh", {})
