"""Annotations over images: which belong to an image, what they look like, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import photos
import pytest
from inspecting import Benches

from webviz import Topic
from webviz_displays.camera import Camera
from webviz_displays.image import Image
from webviz_displays.image.annotated import (
    ANNOTATIONS,
    DETECTIONS,
    MAX_MARKS,
    MAX_MESSAGES,
    MAX_POINTS,
)

SECOND = 1_000_000_000
PIXELS = photos.room(16, 12)[0]
RED = {"r": 1.0, "a": 1.0}


def detection(x: float = 8.0, turn: float = 0.0, **scores: float) -> dict[str, Any]:
    center = {"position": {"x": x, "y": 6.0}, "theta": turn}
    results = [{"hypothesis": {"class_id": k, "score": v}} for k, v in scores.items()]
    return {"bbox": {"center": center, "size_x": 4.0, "size_y": 2.0}, "results": results}


def points(kind: int, *places: tuple[float, float], **changes: Any) -> dict[str, Any]:
    corners = [{"x": x, "y": y} for x, y in places]
    return {"type": kind, "points": corners, "outline_color": RED, "thickness": 1.0, **changes}


class Stage:
    """An image display at work, with images and detections at seconds of its time."""

    def __init__(self, bench: Benches, **values: Any) -> None:
        self.display = Image(annotations_topic=Topic("/found"), **values)
        self.at = bench(self.display)
        self.start_ns = self.at.now_ns

    def image(self, second: float) -> None:
        self._send(photos.RAW, photos.raw(PIXELS, "rgb8"), "/camera/image_raw", second)

    def detect(self, second: float, *detections: dict[str, Any]) -> None:
        topic = self.display.annotations_topic.name
        self._send(DETECTIONS, {"detections": list(detections)}, topic, second)

    def annotate(self, **values: Any) -> None:
        self.at.send(ANNOTATIONS, values, topic="/found")
        self.at.turn()

    def _send(self, type_name: str, values: Any, topic: str, second: float) -> None:
        stamp_ns = self.start_ns + round(second * SECOND)
        self.at.send(type_name, values, frame="camera", topic=topic, stamp_ns=stamp_ns)
        self.at.turn()

    def pane(self) -> Any:
        return self.at.nodes()["pane"]

    def status(self) -> tuple[str, str]:
        return self.at.statuses()["Annotations"]


@pytest.fixture
def stage(bench: Benches) -> Stage:
    return Stage(bench)


def test_an_image_has_the_detections_of_its_stamp_in_any_order(stage: Stage) -> None:
    stage.detect(0.1, detection(5.0))
    stage.detect(0.2, detection(9.0))
    stage.image(0.1)
    (mark,) = stage.pane().marks
    assert mark.points == (3.0, 5.0, 7.0, 5.0, 7.0, 7.0, 3.0, 7.0)
    assert stage.status() == ("OK", "1 annotation.")
    stage.image(0.3)
    assert stage.pane().marks[0].points[0] == 7.0
    assert stage.status() == ("OK", "1 annotation, 0.1 s older than the image.")
    stage.detect(0.3)
    assert stage.pane().marks == ()
    assert stage.status() == ("OK", "0 annotations.")


def test_a_pane_is_replaced_only_when_something_changes(stage: Stage) -> None:
    stage.image(0.0)
    stage.detect(0.0, detection())
    pane = stage.pane()
    stage.at.turn()
    assert stage.pane() is pane
    stage.detect(0.0, detection())
    assert stage.pane() is pane
    stage.detect(0.0, detection(9.0))
    assert stage.pane().picture == pane.picture
    assert stage.pane() is not pane


def test_detections_of_another_time_are_not_shown(stage: Stage) -> None:
    stage.detect(0.0, detection())
    stage.image(3.0)
    assert stage.pane().marks == ()
    level, text = stage.status()
    assert level == "WARN"
    assert text.startswith("None within 1 s of the image: the newest are 3 s older than it.")
    stage.detect(3.0, detection())
    assert len(stage.pane().marks) == 1


def test_only_the_newest_messages_are_kept(stage: Stage) -> None:
    for i in range(MAX_MESSAGES + 1):
        stage.detect(i / 10, detection(float(i)))
    stage.image(0.0)
    assert stage.pane().marks[0].points[0] == MAX_MESSAGES - 2.0
    stage.image(0.1)
    assert stage.pane().marks[0].points[0] == -1.0


def test_annotations_of_another_topic_are_forgotten(stage: Stage) -> None:
    stage.detect(0.0, detection())
    stage.image(0.0)
    assert stage.pane().marks
    stage.at.set("annotations_topic", Topic("/others"))
    stage.detect(0.2, detection(9.0), detection(2.0))
    stage.image(0.0)
    assert len(stage.pane().marks) == 2
    stage.at.set("annotations_topic", Topic())
    stage.image(0.0)
    assert stage.pane().marks == ()
    assert "Annotations" not in stage.at.statuses()


def test_a_detection_is_labelled_with_its_classes_and_rotated(stage: Stage) -> None:
    stage.image(0.0)
    stage.detect(0.0, detection(turn=math.pi / 2, dog=0.25, person=0.5), detection())
    (first, second) = stage.pane().marks
    assert first.text == "person 0.50"
    assert first.about == "Detection 0 · person 0.50 · dog 0.25 · 4 x 2 px"
    assert first.points[:4] == (9.0, 4.0, 9.0, 8.0)  # x to the right becomes down
    assert second.text == ""
    assert first.color != second.color
    stage.at.set("show_labels", False)
    assert stage.pane().marks[0].text == ""


def test_annotations_of_foxglove_have_their_kinds_and_colours(stage: Stage) -> None:
    green = {"g": 1.0, "a": 0.5}
    stage.image(0.0)
    stage.annotate(
        points=[
            points(1, (1.0, 2.0), (3.0, 4.0), outline_colors=[green]),
            points(2, (0.0, 0.0), (4.0, 0.0), (4.0, 4.0), fill_color=green),
            points(3, (0.0, 0.0), (4.0, 0.0)),
            points(4, (0.0, 0.0), (4.0, 0.0)),
        ],
        circles=[{"position": {"x": 5.0, "y": 6.0}, "diameter": 4.0, "outline_color": RED}],
        texts=[{"position": {"x": 1.0}, "text": "two\nlines", "text_color": RED}],
    )
    kinds = ("points", "loop", "strip", "pairs", "circle", "text")
    marks = stage.pane().marks
    assert tuple(mark.kind for mark in marks) == kinds
    assert {mark.color for mark in marks} == {"#ff0000ff"}
    assert marks[0].colors == ("#00ff0080",)
    assert marks[1].fill == "#00ff0080"
    assert marks[4].points == (5.0, 6.0, 7.0, 6.0)
    assert (marks[5].text, marks[5].width) == ("two lines", 12.0)
    assert stage.status() == ("OK", "6 annotations.")


@pytest.mark.parametrize(
    "bad",
    [
        {"points": [points(2, (math.nan, 0.0))]},
        {"points": [points(2, (1e308, 0.0))]},
        {"points": [points(2)]},
        {"points": [points(7, (0.0, 0.0))]},
        {"points": [points(2, (0.0, 0.0), thickness=math.inf)]},
        {"circles": [{"diameter": -1.0}]},
        {"circles": [{"diameter": math.nan}]},
        {"texts": [{"position": {"x": -math.inf}, "text": "far"}]},
    ],
)
def test_invalid_annotations_are_counted_and_the_rest_shown(stage: Stage, bad: Any) -> None:
    stage.image(0.0)
    good = points(2, (0.0, 0.0), (1.0, 0.0))
    stage.annotate(**{**bad, "points": [*bad.get("points", []), good]})
    assert [mark.kind for mark in stage.pane().marks] == ["loop"]
    level, text = stage.status()
    assert level == "ERROR"
    assert text.startswith("1 of 2 annotations have a place, size or kind that is not valid.")


def test_non_finite_colours_are_clamped(stage: Stage) -> None:
    stage.image(0.0)
    color = {"r": math.nan, "g": math.inf, "b": -1e308, "a": 1.0}
    stage.annotate(points=[points(2, (0.0, 0.0), outline_color=color)])
    assert stage.pane().marks[0].color == "#00ff00ff"


def test_a_flood_is_cut(stage: Stage) -> None:
    stage.image(0.0)
    stage.detect(0.0, *[detection()] * (MAX_MARKS + 7))
    assert len(stage.pane().marks) == MAX_MARKS
    assert stage.status() == ("WARN", f"Showing {MAX_MARKS} annotations; 7 more are left out.")


def test_annotations_with_too_many_points_are_dropped(stage: Stage) -> None:
    stage.image(0.0)
    huge = points(3, *[(1.0, 1.0)] * (MAX_POINTS + 1))
    stage.annotate(points=[points(3, (0.0, 0.0)), huge])
    assert len(stage.pane().marks) == 1
    assert stage.status() == ("WARN", "Showing 1 annotation; 1 more are left out.")


def test_the_camera_shows_them_too(bench: Benches) -> None:
    at = bench(Camera(annotations_topic=Topic("/found")))
    at.transform("map", "camera", (1.0, 0.0, 0.0))
    at.send(photos.INFO, photos.info(16, 12), frame="camera", topic="/camera/camera_info")
    at.send(DETECTIONS, {"detections": [detection()]}, frame="camera", topic="/found")
    at.send(photos.RAW, photos.raw(PIXELS, "rgb8"), frame="camera", topic="/camera/image_raw")
    at.turn()
    assert len(at.nodes()["pane"].marks) == 1
    assert at.nodes()["pane"].camera is not None
