"""Boxes of vision_msgs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches

from webviz.files import opening
from webviz.shell.testing import check_details
from webviz_displays.detections import (
    BoundingBox3D,
    BoundingBox3DArray,
    Detection3D,
    Detection3DArray,
)

BOXES, BOX = "vision_msgs/msg/BoundingBox3DArray", "vision_msgs/msg/BoundingBox3D"
DETECTIONS, DETECTION = "vision_msgs/msg/Detection3DArray", "vision_msgs/msg/Detection3D"
NAN = float("nan")
LEFT = {"z": 0.5**0.5, "w": 0.5**0.5}
"""A quarter of a turn."""


def box(x: float = 0.0, size: tuple[float, ...] = (2.0, 1.0, 1.0), turn: Any = LEFT) -> Any:
    center = {"position": {"x": x}, "orientation": turn}
    return {"center": center, "size": dict(zip("xyz", size, strict=True))}


def detection(x: float, **scores: float) -> dict[str, Any]:
    results = [{"hypothesis": {"class_id": k, "score": v}} for k, v in scores.items()]
    return {"bbox": box(x), "results": results}


MESSAGES = {
    BOX: box(),
    BOXES: {"boxes": [box(), box(3.0)]},
    DETECTION: detection(1.0, Person=0.9),
    DETECTIONS: {"detections": [detection(0.0, car=0.4, Person=0.5), detection(3.0)]},
}


def test_boxes_lie_in_their_frame_with_their_sizes(display_bench: Benches) -> None:
    at = display_bench(BoundingBox3DArray(), {"boxes": [box(), box(3.0)]})
    np.testing.assert_allclose(at.xyz("boxes"), [(10, 0, 0), (13, 0, 0)], atol=1e-6)
    node = at.nodes()["boxes"]
    np.testing.assert_allclose(node.scales, [(2, 1, 1)] * 2)
    assert at.statuses()["Boxes"] == ("OK", "Showing 2 boxes.")


def test_edges_are_turned_with_their_box(display_bench: Benches) -> None:
    at = display_bench(BoundingBox3DArray(only_edge=True), {"boxes": [box()]})
    edges = at.xyz("edges")
    assert len(edges) == 12
    reach = np.abs(edges - (10.0, 0.0, 0.0)).reshape(-1, 3).max(axis=0)
    np.testing.assert_allclose(reach, (0.5, 1.0, 0.5), atol=1e-6)


def test_detections_have_the_colour_and_score_of_their_likeliest_class(
    display_bench: Benches,
) -> None:
    display = Detection3DArray(show_score=True, show_class=True)
    at = display_bench(display, MESSAGES[DETECTIONS])
    assert at.nodes()["boxes"].colors.tolist() == [[0, 0, 255], [255, 22, 80]]
    assert at.nodes()["texts"].texts == ("Person 0.50",)
    np.testing.assert_allclose(at.xyz("texts"), [(10.0, 0.0, 0.6)], atol=1e-6)
    values = {"Size": "2 x 1 x 1 m", "Person": "0.50", "car": "0.40"}
    check_details(at.pick("boxes", 0), "Detection 0", values)


def test_a_box_without_a_header_lies_in_the_fixed_frame(bench: Benches) -> None:
    at = bench(BoundingBox3D())
    at.send(BOX, box(4.0))
    at.turn()
    np.testing.assert_allclose(at.xyz("boxes"), [(4, 0, 0)])


@pytest.mark.parametrize(
    "bad",
    [
        box(NAN),
        box(1e308),
        box(size=(NAN, 1.0, 1.0)),
        box(size=(-1.0, 1.0, 1.0)),
        box(size=(0.0, 0.0, 0.0)),
        box(size=(1e300, 1.0, 1.0)),
        box(turn={"w": 0.0}),
        box(turn={"w": NAN}),
    ],
)
def test_an_invalid_box_is_counted_and_the_others_shown(
    display_bench: Benches, bad: dict[str, Any]
) -> None:
    at = display_bench(BoundingBox3DArray(), {"boxes": [bad, box(1.0)]})
    assert at.statuses()["Boxes"] == (
        "ERROR",
        "Boxes with an invalid size, position or orientation: 1 of 2. Fix the publisher.",
    )
    np.testing.assert_allclose(at.xyz("boxes"), [(11, 0, 0)], atol=1e-6)


def test_files_with_the_classes_of_vision_msgs_open_complete(tmp_path: Path) -> None:
    names = ("BoundingBox3D", "BoundingBox3DArray", "Detection3D", "Detection3DArray")
    items = [
        {
            "Class": f"vision_msgs_rviz_plugins/{name}",
            "Name": name,
            "Only Edge": True,
            "Line Width": 0.1,
            "Alpha": 0.5,
            "Topic": {"Value": "/found"},
        }
        for name in names
    ]
    path = tmp_path / "found.rviz"
    path.write_text(json.dumps({"Visualization Manager": {"Displays": items}}))
    config = opening.load(path)
    assert [type(each).__name__ for each in config.displays] == list(names)
    assert all(each.only_edge and each.alpha == 0.5 for each in config.displays)  # pyright: ignore[reportAttributeAccessIssue]
    assert not config.report


class TestBoundingBox3DArray(BuiltInChecks):
    display = BoundingBox3DArray
    messages = MESSAGES


class TestBoundingBox3D(BuiltInChecks):
    display = BoundingBox3D
    messages = MESSAGES


class TestDetection3DArray(BuiltInChecks):
    display = Detection3DArray
    messages = MESSAGES
    variants = (Detection3DArray, lambda: Detection3DArray(only_edge=True, show_score=True))


class TestDetection3D(BuiltInChecks):
    display = Detection3D
    messages = MESSAGES
