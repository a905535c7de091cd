"""The displays of Autoware's objects: shapes, texts, vectors, covariances and paths."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from autoware_scenes import (
    ALL_FOLLOWED,
    ALL_FORESEEN,
    ALL_FOUND,
    CAR,
    DETECTED,
    DETECTED_OBJECTS,
    FOLLOWED,
    FORESEEN,
    HEAP,
    MAN,
    PREDICTED,
    TRACKED,
    pose_at,
    unaccelerated,
)
from built_in_checks import BuiltInChecks
from inspecting import Benches
from plain_scenes import in_moving_frame

from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.autoware import DetectedObjects, PredictedObjects, TrackedObjects, objects
from webviz_displays.autoware.objects_look import (
    ClassColors,
    MeasuredTexts,
    ObjectCovariances,
    ObjectVectors,
    PredictedPaths,
    ShapeView,
    TrackedTexts,
)

NAN = math.nan


def edges_of(at: DisplayBench, number: int, key: str = "shapes") -> np.ndarray:
    """The lines of an object in the fixed frame."""
    return at.xyz(key)[at.nodes()[key].ids == number]


def test_shapes_are_edges_in_the_frame_of_their_object(display_bench: Callable) -> None:
    at = display_bench(TrackedObjects(), FOLLOWED)
    car, man, heap = (edges_of(at, number) for number in range(3))
    low, high = car.min((0, 1)), car.max((0, 1))
    np.testing.assert_allclose((low, high), [(9.5, -1, 0), (10.5, 1, 1)], atol=1e-6)
    assert len(car) == 12 + 5, "a box with the triangle of its front"
    assert len(man) == 20 + 20 + 4
    np.testing.assert_allclose(np.ptp(man.reshape(-1, 3), axis=0)[2], 1.0, atol=1e-6)
    assert len(heap) == 3 + 3 + 3
    assert at.nodes()["shapes"].width == 0.03
    at.set("shape.shape_type", "Skeleton 2D")
    assert (edges_of(at, 0)[..., 2] == 0).all()
    assert len(edges_of(at, 0)) == 4 + 3
    at.set("shape.shape_type", "None")
    assert "shapes" not in at.nodes()


def test_a_box_whose_front_may_be_its_back_has_ticks(display_bench: Callable) -> None:
    at = display_bench(DetectedObjects(), {"objects": [unaccelerated(CAR)]})
    assert len(edges_of(at, 0)) == 12 + 2
    at.set("shape.bbox_footprint", True)
    assert len(edges_of(at, 0)) == 12 + 2 + 9


def test_solids_are_transparent_and_polygons_stay_lines(display_bench: Callable) -> None:
    at = display_bench(DetectedObjects(shape=ShapeView(shape_type="Fill")), DETECTED_OBJECTS)
    box, cylinder = at.nodes()["solids box"], at.nodes()["solids cylinder"]
    assert (box.opacity, cylinder.opacity) == (0.75, 0.75)
    np.testing.assert_allclose(box.scales, [(2.0, 1.0, 1.0)])
    np.testing.assert_allclose(abs(box.wxyzs), [(0.5**0.5, 0, 0, 0.5**0.5)], atol=1e-6)
    assert set(at.nodes()["shapes"].ids) == {2}


def test_classes_have_their_colours_and_texts(display_bench: Callable) -> None:
    texts = TrackedTexts(velocity=True, acceleration=True, existence_probability=True)
    at = display_bench(
        TrackedObjects(per_class_color=ClassColors(value=True), text=texts), FOLLOWED
    )
    node = at.nodes()["texts"]
    assert node.texts[:5] == ("CAR", "0000", "7[km/h]", "5.0[m/s^2]", "0.750")
    assert [node.texts[5], node.texts[10]] == ["PEDESTRIAN", "UNKNOWN"]
    assert node.colors[[0, 5, 10]].tolist() == [[30, 144, 255], [255, 192, 203], [255] * 3]
    np.testing.assert_allclose(at.xyz("texts")[2], (9.0, 0.0, -0.5), atol=1e-6)
    at = display_bench(DetectedObjects(text=MeasuredTexts(velocity=True)), DETECTED_OBJECTS)
    assert at.nodes()["texts"].texts[:2] == ("CAR", "7[km/h]")


def test_velocities_and_turns_are_lines(display_bench: Callable) -> None:
    at = display_bench(TrackedObjects(vector=ObjectVectors(yaw_rate=True)), FOLLOWED)
    np.testing.assert_allclose(edges_of(at, 0, "velocities")[0, 1], (10, 2, 0.5), atol=1e-6)
    turned = edges_of(at, 1, "yaw rates")[-1, 0]
    expected = (12 + 1.6 * math.cos(0.5), 1.6 * math.sin(0.5), 0.5)
    np.testing.assert_allclose(turned, expected, atol=1e-6)


def test_covariances_reach_as_far_as_their_interval(display_bench: Callable) -> None:
    look = ObjectCovariances(yaw=True, twist=True, yaw_rate=True, confidence_interval="70%")
    at = display_bench(TrackedObjects(covariance=look), FOLLOWED)
    node = at.nodes()["ellipses"]
    ids = node.ids.tolist()
    assert ids == [0, 0, 1, 1, 2, 2]
    sizes = sorted(node.scales[0, :2].tolist())
    np.testing.assert_allclose(sizes, (2 * 1.552 * 0.2, 2 * 1.552 * 0.3), rtol=1e-5)
    np.testing.assert_allclose(at.xyz("ellipses")[1], (10.0, 2.0, 0.5), atol=1e-6)
    half = 1.036 * 0.2
    first = edges_of(at, 1, "yaws")[0, 1] - (12, 0, 0.5)
    np.testing.assert_allclose(first, (math.cos(half), -math.sin(half), 0), atol=1e-6)
    assert len(edges_of(at, 1, "yaw rate intervals")) == 4


def test_paths_have_arrowheads_footprints_and_confidences(display_bench: Callable) -> None:
    at = display_bench(PredictedObjects(path=PredictedPaths(path_footprint=True)), FORESEEN)
    assert len(edges_of(at, 1, "paths")) == 2 * (4 + 3 * 4)
    np.testing.assert_allclose(edges_of(at, 1, "paths")[0], [(12, 0, 0), (12.5, 0, 0)], atol=1e-6)
    assert len(edges_of(at, 1, "path footprints")) == 2 * 5 * 44
    assert at.nodes()["texts"].texts.count("0.500000") == 6
    at.set("path.path_resolution", "Simple")
    assert len(edges_of(at, 1, "paths")) == 2 * (4 + 3 * 2)
    assert len(edges_of(at, 1, "path footprints")) == 2 * 3 * 44


def test_objects_that_stand_or_move_are_chosen(display_bench: Callable) -> None:
    at = display_bench(TrackedObjects(dynamic_status="Static"), FOLLOWED)
    assert set(at.nodes()["shapes"].ids) == {1}
    at.set("dynamic_status", "Dynamic")
    assert set(at.nodes()["shapes"].ids) == {0, 2}
    nothing = display_bench(
        TrackedObjects(dynamic_status="Static"), {"objects": FOLLOWED["objects"][:1]}
    )
    sentence = "None of 1 object has this Dynamic Status."
    assert nothing.statuses()["Objects"] == ("WARN", sentence)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ([], "No objects in the newest message."),
        (
            [unaccelerated(MAN), unaccelerated(HEAP | {"shape": {"dimensions": {"x": NAN}}})],
            "1 of 2 objects left out: the pose or shape is not finite or too large. "
            "Fix the publisher.",
        ),
    ],
)
def test_skipped_objects_are_reported(
    change: list[Any], sentence: str, display_bench: Callable
) -> None:
    at = display_bench(DetectedObjects(), {"objects": change})
    assert at.statuses()["Objects"] == ("WARN", sentence)


def test_far_from_the_origin_edges_stay_sharp(display_bench: Callable) -> None:
    far = unaccelerated(CAR)
    far["kinematics"]["pose_with_covariance"] = {"pose": pose_at(89_000.0, 43_000.0, 0.5)}
    at = display_bench(DetectedObjects(), {"objects": [far]})
    low = edges_of(at, 0).min((0, 1))
    np.testing.assert_allclose(low, (89_009.0, 42_999.5, 0.0), atol=1e-3)


def test_too_many_objects_are_cut_with_a_warning(
    display_bench: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(objects, "MAX_OBJECTS", 1)
    at = display_bench(DetectedObjects(), DETECTED_OBJECTS)
    assert at.statuses()["Objects"] == ("WARN", "Showing the first 1 of 3 objects.")


class TestDetectedObjects(BuiltInChecks):
    display = DetectedObjects
    scene = in_moving_frame(DETECTED, ALL_FOUND)
    variants = (
        DetectedObjects,
        lambda: DetectedObjects(shape=ShapeView(shape_type="Fill")),
    )


class TestPredictedObjects(BuiltInChecks):
    display = PredictedObjects
    scene = in_moving_frame(PREDICTED, ALL_FORESEEN)


class TestTrackedObjects(BuiltInChecks):
    display = TrackedObjects
    scene = in_moving_frame(TRACKED, ALL_FOLLOWED)


def test_selecting_pedestrian_of_autoware(turned: Benches) -> None:
    check_details(
        turned(TrackedObjects(), FOLLOWED).pick("shapes", 30),
        "PEDESTRIAN 1111",
        {"Probability": "75 %", "Size": "0.5 x 0.5 x 1 m", "Speed": "2.00 m/s", "Id": "11" * 16},
    )
