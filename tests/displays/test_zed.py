"""The display of what ZED cameras detect."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from perception_scenes import NAN, ZED_CAR, ZED_OBJECTS, ZED_PERSON, ZED_SCENE
from plain_scenes import in_moving_frame

from webviz.shell.testing import check_details
from webviz_displays import zed
from webviz_displays.zed import BODIES, ZedOdDisplay


def scene(*objects: dict[str, Any]) -> dict[str, Any]:
    return {"objects": objects}


def test_boxes_have_the_colours_of_their_numbers_and_corners_those_of_tracking(
    display_bench: Callable,
) -> None:
    at = display_bench(ZedOdDisplay(), ZED_SCENE)
    boxes, corners = at.nodes()["boxes"], at.nodes()["corners"]
    assert len(boxes.segments) == 2 * 12
    np.testing.assert_allclose(
        at.xyz("boxes")[0], [(10.6, -0.7, 0.5), (11.4, -0.7, 0.5)], atol=1e-6
    )
    assert boxes.colors[0, 0].tolist() == [150, 44, 88]
    assert boxes.colors[-1, 0].tolist() == [60, 120, 240]
    assert (boxes.width, boxes.unit, boxes.opacity) == (0.05, "m", 0.75)
    lengths = np.linalg.norm(np.diff(boxes.segments[:12], axis=1), axis=-1)
    assert sorted(np.round(lengths.ravel(), 3)) == [0.4] * 4 + [0.5] * 4 + [0.8] * 4
    assert corners.colors[[0, 8]].tolist() == [[0, 255, 0], [0, 0, 0]]
    np.testing.assert_allclose(corners.scales, 0.1)
    assert at.nodes()["labels"].texts == ("3-Vehicle [Car]", "Person-0")
    assert at.nodes()["labels"].height == pytest.approx(0.1)
    assert at.statuses()["Objects"] == ("OK", "2 of 2 objects shown.")


def test_skeletons_have_the_joints_of_their_format_without_those_that_are_not_seen(
    display_bench: Callable,
) -> None:
    at = display_bench(ZedOdDisplay(), scene(ZED_CAR, ZED_PERSON))
    joints, bones = at.nodes()["joints"], at.nodes()["bones"]
    assert len(joints.positions) == 17, "the left ear is not seen, and 52 are not in the format"
    assert len(bones.segments) == len(BODIES[0].bones) - 1 == 18
    assert joints.colors[0].tolist() == [160, 170, 190]
    assert (joints.opacity, bones.width) == (0.75, pytest.approx(0.02))
    np.testing.assert_allclose(joints.scales, 0.04)
    np.testing.assert_allclose(at.xyz("bones")[0], [(10, 0, 1.1), (10, 0, 0.95)], atol=1e-6)
    at.set("show_skeletons", False)
    assert set(at.nodes()) == {"boxes", "corners", "pivots", "labels"}


def test_every_bone_is_between_joints_of_its_format() -> None:
    for body, count in zip(BODIES, (18, 34, 38, 70), strict=True):
        assert body.joints == count
        assert len(np.unique(np.sort(body.bones, axis=1), axis=0)) == len(body.bones)
        assert set(body.bones.ravel().tolist()) == set(range(count))


@pytest.mark.parametrize(
    ("objects", "properties", "sentence"),
    [
        ([], {}, "No objects in the newest message."),
        ([ZED_CAR | {"tracking_state": 2}], {}, "0 of 1 object shown: 1 not tracked."),
        (
            [ZED_CAR, ZED_PERSON | {"position": (NAN, 0.0, 0.0)}],
            {},
            "1 of 2 objects shown: 1 without a position.",
        ),
        (
            [ZED_CAR],
            {"show_labels": False, "show_bounding_boxes": False, "show_skeletons": False},
            "Boxes, skeletons and labels are switched off.",
        ),
    ],
)
def test_skipped_objects_are_reported(
    objects: list[Any], properties: dict[str, Any], sentence: str, display_bench: Callable
) -> None:
    at = display_bench(ZedOdDisplay(**properties), scene(*objects))
    assert at.statuses()["Objects"] == ("WARN", sentence)


def test_objects_out_of_sight_are_left_out_without_a_warning(display_bench: Callable) -> None:
    at = display_bench(
        ZedOdDisplay(),
        scene(ZED_PERSON, ZED_CAR | {"tracking_state": 3}, ZED_CAR | {"label_id": -1}),
    )
    assert at.nodes()["labels"].texts == ("Person-0",)
    assert at.statuses()["Objects"] == ("OK", "1 of 3 objects shown: 2 not tracked.")


def test_boxes_without_corners_and_unknown_skeletons_are_named(display_bench: Callable) -> None:
    corners = [{"kp": (NAN, NAN, NAN)}] * 8
    at = display_bench(
        ZedOdDisplay(),
        scene(ZED_CAR, ZED_PERSON | {"bounding_box_3d": {"corners": corners}, "body_format": 9}),
    )
    assert len(at.nodes()["boxes"].segments) == 12
    statuses = at.statuses()
    assert statuses["Boxes"] == ("WARN", "1 of 2 boxes left out: corners are missing or invalid.")
    assert statuses["Skeletons"] == ("WARN", "Body format 9 is unknown. Fix the publisher.")


def test_too_many_objects_are_cut_with_a_warning(
    display_bench: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zed, "MAX_OBJECTS", 1)
    at = display_bench(ZedOdDisplay(), scene(ZED_CAR, ZED_PERSON))
    assert at.nodes()["labels"].texts == ("3-Vehicle [Car]",)
    assert at.statuses()["Objects"] == ("WARN", "1 of 2 objects shown: 1 too many.")


class TestZedOdDisplay(BuiltInChecks):
    display = ZedOdDisplay
    scene = in_moving_frame(ZED_OBJECTS, ZED_SCENE)


def test_selecting_car_of_a_zed_camera(turned: Benches) -> None:
    check_details(
        turned(ZedOdDisplay(), ZED_SCENE).pick("boxes", 3),
        "3-Vehicle [Car]",
        {
            "Kind": "Vehicle > Car",
            "Confidence": "87.5 %",
            "Velocity": "1.5, 0, 0 m/s",
            "Size": "0.8 x 0.4 x 0.5 m",
            "Tracking": "tracked",
        },
    )
