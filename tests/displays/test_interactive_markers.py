"""Interactive markers: what is filled in, and what is wrong with them."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import interactive_markers

from webviz.data.messages import decode, encode
from webviz_displays.interactive_markers import InteractiveMarkers
from webviz_displays.interactive_markers.completion import (
    FAR,
    Completed,
    RefusedMarker,
    completed,
    unique_names,
)
from webviz_displays.interactive_markers.menus import MAX_DEPTH, can_choose, menu_of
from webviz_displays.interactive_markers.reading import UPDATE, read_update

MARKER = "visualization_msgs/msg/InteractiveMarker"
NAN = math.nan
MENU, MOVE_AXIS, MOVE_PLANE, ROTATE_AXIS, MOVE_ROTATE = 1, 3, 4, 5, 6


def completed_marker(**values: Any) -> Completed | RefusedMarker:
    """A marker as its message is completed."""
    return completed(decode(MARKER, encode(MARKER, values)))


def part(**control: Any) -> Any:
    result = completed_marker(scale=2.0, controls=[control])
    assert isinstance(result, Completed)
    return result.parts[0]


def test_controls_without_markers_get_handles_in_the_size_and_colour_of_ros() -> None:
    arrows = part(interaction_mode=MOVE_AXIS).shapes
    assert [each.tolist() for each in (arrows.contents[0].points, arrows.contents[1].points)] == [
        [[1.0, 0.0, 0.0], [1.8, 0.0, 0.0]],
        [[-1.0, 0.0, 0.0], [-1.8, 0.0, 0.0]],
    ]
    np.testing.assert_allclose(arrows.scales[0], (0.3, 0.5, 0.4))
    np.testing.assert_allclose(arrows.colors[0], (1.0, 0.0, 0.0, 0.5))

    up = {"w": math.sqrt(0.5), "y": math.sqrt(0.5)}
    ring = part(interaction_mode=ROTATE_AXIS, orientation=up).shapes
    content = ring.contents[0]
    assert (content.points.shape, content.colors.shape) == ((216, 3), (72, 4))
    np.testing.assert_allclose(ring.scales[0], 2.0)
    radii = np.hypot(content.points[:, 1], content.points[:, 2])
    assert sorted(set(radii.round(6).tolist())) == [0.5, 0.65]
    assert not content.points[:, 0].any()
    np.testing.assert_allclose(
        content.colors[[0, 2]], [(0, 0, 0.6, 0.5), (0, 0, 1, 0.5)], atol=1e-6
    )

    ring = part(interaction_mode=MOVE_ROTATE, orientation=up).shapes.contents[0]
    expected = [(0, 0, 0.6, 0.5)] * 2 + [(0, 0, 1, 0.5)] * 2
    np.testing.assert_allclose(ring.colors[:8], expected * 2, atol=1e-6)
    corners = ring.points.reshape(-1, 3, 3)
    angles = np.rad2deg(np.arctan2(corners[..., 2], corners[..., 1])).round(3) % 360
    assert angles[:4].tolist() == [[0, 10, 10], [10, 10, 20], [0, 10, 0], [10, 20, 20]]
    radii = np.hypot(corners[..., 1], corners[..., 2]).round(6)
    assert (radii == 0.65).sum(axis=1)[:4].tolist() == [1, 1, 2, 2]

    plane = part(interaction_mode=MOVE_PLANE).shapes.contents[0]
    assert plane.points.shape == (216, 3)
    np.testing.assert_allclose(plane.colors, [(1, 0, 0, 0.5)] * 72)

    title = part(interaction_mode=MENU, description="Options")
    assert (title.control.facing, title.shapes.contents[0].text) == ("view_facing", "Options")
    np.testing.assert_allclose(title.shapes.positions[0], (-0.05, 0.0, 2.35))
    np.testing.assert_allclose(title.shapes.scales[0], 0.5)
    np.testing.assert_allclose(title.shapes.colors[0], (1.0, 1.0, 1.0, 1.0))
    for mode in (0, 2, 7, 8, 9):
        assert len(part(interaction_mode=mode).shapes) == 0


def test_missing_fields_get_their_defaults() -> None:
    result = completed_marker(
        controls=[{"orientation": {"w": 0.0}, "markers": [{"type": 1}]}, {}, {}]
    )
    assert isinstance(result, Completed)
    assert (result.scale, result.parts[0].control.wxyz) == (1.0, (1.0, 0.0, 0.0, 0.0))
    assert [each.control.name for each in result.parts] == ["", "_u0", "_u1"]
    assert result.parts[0].shapes.scales.tolist() == [[1.0, 1.0, 1.0]]
    arrow = {"type": 0, "scale": {"x": 0.1}, "points": [{}, {"x": 1.0}]}
    assert part(markers=[arrow]).shapes.scales.tolist() == [[0.1, 1.0, 0.0]]
    assert list(unique_names(["a", "a", "a_u0", "a"])) == ["a", "a_u0", "a_u0_u1", "a_u2"]


def test_invalid_markers_and_controls_name_the_fault() -> None:
    for values in (
        *({"scale": value} for value in (NAN, math.inf, 3e38)),
        *({"pose": {"position": {"x": value}}} for value in (NAN, math.inf, -1e308)),
        *({"pose": {"orientation": {"x": value}}} for value in (NAN, math.inf, 1e308)),
    ):
        assert completed_marker(**values) == RefusedMarker("", FAR)
    bad = [
        ({"interaction_mode": 10}, "unknown interaction mode, 10"),
        ({"orientation_mode": 3}, "unknown orientation mode, 3"),
        ({"orientation": {"x": NAN}}, "not finite"),
        ({"markers": [{}] * 2001}, "the limit is 2000"),
        ({"markers": [{"points": [{}] * 50_001}] * 2}, "100002 points; the limit is 100000"),
        ({"markers": [{"text": "x" * 10_001}]}, "a text of 10001 characters; the limit is 10000"),
        ({"name": "n" * 1001}, f"Control '{'n' * 59}…' has a name of 1001 characters"),
    ]
    for point in ({"x": NAN}, {"y": 1e308}):
        result = completed_marker(controls=[{"markers": [{}, {"type": 5, "points": [point, {}]}]}])
        assert isinstance(result, Completed)
        assert "has 1 marker that cannot be drawn: not finite, or too large" in result.problems[0]
    for control, problem in bad:
        result = completed_marker(controls=[{}, control])
        assert isinstance(result, Completed)
        assert len(result.parts) == 1
        assert problem in result.problems[0]


def test_overlong_names_titles_and_frames_are_reported() -> None:
    result = completed_marker(
        name="a", description="t" * 1001, controls=[{"name": "b"}, {"name": "c"}]
    )
    assert isinstance(result, Completed)
    assert (result.name, len(result.description)) == ("a", 1000)
    assert [each.control.name for each in result.parts] == ["b", "c"]
    assert result.problems == ("Only 1000 of the 1001 characters of its title are shown.",)
    for values, what in (
        ({"name": "n" * 1001}, "name"),
        ({"header": {"frame_id": "f" * 1001}}, ""),
    ):
        invalid_marker = completed_marker(**values)
        assert isinstance(invalid_marker, RefusedMarker)
        assert (
            f"{what or 'frame id'} has 1001 characters; the limit is 1000" in invalid_marker.reason
        )


@pytest.mark.parametrize(
    ("count", "problems"), [(200, ()), (201, ("Only 200 of 201 controls are shown.",))]
)
def test_a_marker_has_at_most_200_controls(count: int, problems: tuple[str, ...]) -> None:
    result = completed_marker(controls=[{}] * count)
    assert isinstance(result, Completed)
    assert (len(result.parts), result.problems) == (200, problems)


def test_duplicate_names_are_reported() -> None:
    update = {"type": 1, "markers": [{"name": "a"}, {"name": "a", "scale": 3.0}, {"name": "b"}]}
    news = read_update(encode(UPDATE, update)).news
    assert news
    a, b = news.markers.values()
    assert isinstance(a, Completed)
    assert isinstance(b, Completed)
    assert a.scale == 3.0
    assert a.problems == ("2 markers of a message have this name. Correct the server.",)
    assert not b.problems


def entries(*rows: tuple[int, int, str, int]) -> list[Any]:
    values = [
        {"id": id, "parent_id": parent, "title": title, "command_type": kind}
        for id, parent, title, kind in rows
    ]
    return decode(MARKER, encode(MARKER, {"menu_entries": values})).menu_entries


def test_menus_are_nested_checked_and_free_of_shell_commands() -> None:
    menu, problems = menu_of(
        entries((1, 0, "[x]On", 0), (2, 0, "More", 1), (3, 2, "[ ] Off", 0), (4, 0, "rm", 1))
    )
    assert [(each.title, each.is_checked) for each in menu] == [
        ("On", True),
        ("More", None),
        ("rm", None),
    ]
    assert [(each.title, each.is_checked) for each in menu[1].entries] == [("Off", False)]
    assert not problems
    assert [can_choose(menu, id) for id in (1, 2, 3, 4, 5)] == [True, False, True, False, False]

    menu, problems = menu_of(entries((2, 3, "early", 0), (3, 0, "late", 0), (3, 0, "twice", 0)))
    assert [each.id for each in menu] == [3]
    assert [text.split(".")[0] for text in problems] == [
        "Menu entry 2 precedes its parent 3",
        "The menu has an invalid or repeated id, 3",
    ]
    menu, problems = menu_of(entries((1, 2, "round", 0), (2, 1, "and round", 0), (5, 5, "", 0)))
    assert (menu, len(problems)) == ((), 3)
    assert menu_of(entries((1, 0, "x" * 10_000, 0)))[0][0].title == "x" * 199 + "…"
    menu, problems = menu_of(entries(*((n, n - 1, "", 0) for n in range(1, 2000))))
    assert "1000 of its 1999" in problems[0]
    depth = 0
    while menu:
        menu, depth = menu[0].entries, depth + 1
    assert depth == MAX_DEPTH


class TestInteractiveMarkers(BuiltInChecks):
    display = InteractiveMarkers
    scene = interactive_markers
    needs: ClassVar = {
        "show_descriptions": {"interactive_markers_namespace": "/arm"},
        "show_axes": {"interactive_markers_namespace": "/arm"},
        "show_visual_aids": {"interactive_markers_namespace": "/arm"},
        "enable_transparency": {"interactive_markers_namespace": "/arm"},
        "enabled": {"interactive_markers_namespace": "/arm"},
    }
