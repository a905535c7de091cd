"""Marker and MarkerArray: actions, lifetimes, transforms, namespaces and statuses."""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
import PIL.Image
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import markers as markers_of_both_kinds
from inspecting import Benches

from webviz import Details
from webviz.shell.testing import DisplayBench, check_details
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import SECOND
from webviz_displays.markers import Marker, MarkerArray, store
from webviz_displays.markers.blocks import BLOCK

MARKER, ARRAY = "visualization_msgs/msg/Marker", "visualization_msgs/msg/MarkerArray"
ADD, DELETE, DELETEALL = 0, 2, 3
CUBE, TEXT, MESH = 1, 9, 10
NAN = float("nan")


def cube(id: int = 0, x: float = 0.0, frame: str = "map", **more: Any) -> dict[str, Any]:
    """A red cube of 1 m; a stamp of 0 is the latest transform."""
    more.setdefault("stamp_ns", 0)
    stamp_ns = more.pop("stamp_ns")
    values: dict[str, Any] = {
        "header": header(frame, stamp_ns),
        "ns": "a",
        "id": id,
        "type": CUBE,
        "pose": {"position": {"x": x}, "orientation": {"w": 1.0}},
        "scale": {"x": 1.0, "y": 1.0, "z": 1.0},
        "color": {"r": 1.0, "a": 1.0},
    }
    return values | more


@pytest.fixture
def marker_bench(bench: Benches) -> Callable[..., Any]:
    """A bench that has drawn arrays of markers."""

    def make(*arrays: list[dict[str, Any]], **properties: Any) -> DisplayBench:
        at = bench(MarkerArray(**properties))
        at.transform("map", "base", (10.0, 0.0, 0.0))
        for markers in arrays:
            send(at, *markers)
        return at

    return make


def send(bench: DisplayBench, *markers: dict[str, Any]) -> None:
    bench.send(ARRAY, {"markers": list(markers)})
    bench.turn()
    bench.settle()


def xs(bench: DisplayBench) -> list[float]:
    """Return where the cubes are along x, sorted."""
    nodes = [bench.xyz(key)[:, 0] for key in bench.nodes() if key.startswith("box")]
    return sorted(np.concatenate(nodes).round(6).tolist()) if nodes else []


# Actions


def test_markers_are_added_changed_and_deleted_in_order(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0), cube(2, 2.0)], [cube(2, 3.0), cube(3, 4.0)])
    assert xs(bench) == [1.0, 3.0, 4.0]
    send(bench, cube(1, action=DELETE), cube(9, action=DELETE))
    assert xs(bench) == [3.0, 4.0]


def test_no_message_of_a_turn_is_lost(marker_bench: Benches) -> None:
    bench = marker_bench()
    for index in range(50):
        bench.send(ARRAY, {"markers": [cube(index, float(index))]})
    bench.turn()
    assert xs(bench) == list(range(50))


def test_very_many_markers_are_taken_turn_by_turn_and_shown_together(
    marker_bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store, "AT_ONCE", 2)
    bench = marker_bench([cube(1, 1.0), cube(2, 2.0)])
    anew = [cube(id, 10.0 + id, ns="b") for id in range(5)]
    bench.send(ARRAY, {"markers": [cube(0, action=DELETEALL, ns=""), *anew]})
    for _ in range(3):  # each of which takes two
        bench.turn()
        assert (xs(bench), bench.runner.is_busy()) == ([1.0, 2.0], True)
    bench.turn()
    assert (xs(bench), bench.runner.is_busy()) == ([10.0, 11.0, 12.0, 13.0, 14.0], False)


def test_a_message_after_very_many_markers_is_taken_after_all_of_them(
    marker_bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store, "AT_ONCE", 2)
    bench = marker_bench()
    bench.send(ARRAY, {"markers": [cube(id, 1.0 + id) for id in range(5)]})
    bench.turn()
    assert xs(bench) == []
    send(bench, cube(4, 9.0))
    assert xs(bench) == [1.0, 2.0, 3.0, 4.0, 9.0]


def test_delete_all_spares_what_comes_after_it(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0), cube(2, 2.0, ns="b")])
    send(bench, cube(0, action=DELETEALL, ns=""), cube(0, 5.0))
    assert xs(bench) == [5.0]
    assert "Duplicates" not in bench.statuses()


def test_namespaces_are_offered_as_switches_with_their_counts(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1), cube(2), cube(3, ns="b")], namespaces={"a": False})
    assert bench.runner.report().offered == {"namespaces": {"a": 2, "b": 1}}
    send(bench, cube(3, action=DELETE, ns="b"), cube(4, ns=""))
    assert bench.runner.report().offered == {"namespaces": {"a": 2, "": 1}}


def test_delete_all_of_a_namespace_spares_the_others(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0), cube(2, 2.0, ns="b")], [cube(0, action=DELETEALL, ns="b")])
    assert xs(bench) == [1.0]


def test_the_last_of_several_actions_on_one_marker_counts(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0), cube(1, action=DELETE), cube(1, 2.0)])
    assert xs(bench) == [2.0]
    assert "Duplicates" not in bench.statuses()
    send(bench, cube(1, 3.0), cube(1, action=DELETE))
    assert xs(bench) == []


def test_a_marker_that_is_there_twice_is_reported(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0), cube(1, 2.0)])
    assert xs(bench) == [2.0]
    level, text = bench.statuses()["Duplicates"]
    assert (level, "a/1" in text) == ("WARN", True)
    send(bench, cube(1, 1.0))
    assert "Duplicates" not in bench.statuses()


def test_numbers_that_are_not_finite_refuse_one_version_but_no_deletion(
    marker_bench: Benches,
) -> None:
    bench = marker_bench([cube(1, 1.0), cube(2, 2.0)], [cube(1, NAN), cube(2, 3.0)])
    assert xs(bench) == [1.0, 3.0]
    assert bench.statuses()["Marker a/1"][0] == "ERROR"
    send(bench, cube(2, NAN, action=DELETE))
    assert xs(bench) == [1.0]
    send(bench, cube(1, 5.0))
    assert xs(bench) == [5.0]
    assert "Marker a/1" not in bench.statuses()


def test_unknown_actions_and_types_are_reported(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0, action=1), cube(2, 2.0, type=42), cube(3, 3.0)])
    statuses = bench.statuses()
    assert "Unknown action 1" in statuses["Action"][1]
    assert "type 42 is unknown" in statuses["Marker a/2"][1]
    assert xs(bench) == [3.0]


# Lifetimes


def test_a_marker_expires_its_lifetime_after_it_arrived(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0, lifetime={"sec": 2}), cube(2, 2.0)])
    bench.turn(1.9)
    assert xs(bench) == [1.0, 2.0]
    send(bench, cube(1, 1.0, lifetime={"sec": 2}))
    bench.turn(1.9)
    assert xs(bench) == [1.0, 2.0]
    bench.turn(0.2)
    assert xs(bench) == [2.0]


def test_tiny_and_negative_lifetimes_mean_for_ever(marker_bench: Benches) -> None:
    bench = marker_bench(
        [cube(1, 1.0, lifetime={"nanosec": 100_000}), cube(2, 2.0, lifetime={"sec": -1})]
    )
    bench.turn(1000.0)
    assert xs(bench) == [1.0, 2.0]


def test_expired_markers_are_reported_with_their_age(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0, lifetime={"sec": 1})])
    bench.turn(4.0)
    level, text = bench.statuses()["Markers"]
    assert level == "WARN"
    assert "a/1, expired 3 s ago" in text
    bench.turn(2.0)
    assert "a/1, expired 5 s ago" in bench.statuses()["Markers"][1]
    send(bench, cube(2), cube(2, action=DELETE), cube(3))
    send(bench, cube(3, action=DELETE))
    assert "a/3, was deleted just now" in bench.statuses()["Markers"][1]


# Transforms


def test_each_marker_is_placed_by_its_own_header(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0), cube(2, 1.0, "base"), cube(3, 1.0, "/base")])
    assert xs(bench) == [1.0, 11.0, 11.0]


def test_a_marker_waits_for_its_transform_and_the_former_version_stays(
    marker_bench: Benches,
) -> None:
    bench = marker_bench()
    bench.transform("map", "odom", (100.0, 0.0, 0.0), stamp_ns=SECOND)
    send(bench, cube(1, 1.0, "odom", stamp_ns=SECOND), cube(2, 2.0))
    assert xs(bench) == [2.0, 101.0]
    send(bench, cube(1, 5.0, "odom", stamp_ns=2 * SECOND))
    send(bench, cube(1, 6.0, "odom", stamp_ns=3 * SECOND))
    bench.turn(2.0)
    assert xs(bench) == [2.0, 101.0]
    level, text = bench.statuses()["Transform"]
    assert (level, text.startswith("1 marker (a/1) waits for a transform.")) == ("ERROR", True)
    bench.transform("map", "odom", (200.0, 0.0, 0.0), stamp_ns=2 * SECOND)
    bench.turn()
    assert xs(bench) == [2.0, 205.0]  # however seldom one looks
    bench.transform("map", "odom", (300.0, 0.0, 0.0), stamp_ns=3 * SECOND)
    bench.turn()
    assert xs(bench) == [2.0, 306.0]
    bench.turn(1.0)
    assert "Transform" not in bench.statuses()


def test_a_marker_that_is_deleted_while_it_waits_is_not_drawn_later(marker_bench: Benches) -> None:
    bench = marker_bench()
    bench.transform("map", "odom", (100.0, 0.0, 0.0), stamp_ns=SECOND)
    send(bench, cube(1, 1.0, "odom", stamp_ns=2 * SECOND), cube(2, 2.0))
    send(bench, {**cube(1), "action": 2})
    bench.transform("map", "odom", (200.0, 0.0, 0.0), stamp_ns=3 * SECOND)
    bench.turn()
    assert xs(bench) == [2.0]
    bench.turn(2.0)
    assert "Transform" not in bench.statuses()


def test_a_marker_stays_where_its_frame_was_unless_it_is_locked(marker_bench: Benches) -> None:
    bench = marker_bench()
    bench.transform("map", "odom", (100.0, 0.0, 0.0), stamp_ns=SECOND)
    send(bench, cube(1, 1.0, "odom"), cube(2, 2.0, "odom", frame_locked=True))
    bench.transform("map", "odom", (200.0, 0.0, 0.0), stamp_ns=2 * SECOND)
    bench.turn()
    assert xs(bench) == [101.0, 202.0]


def test_markers_move_with_the_fixed_frame(marker_bench: Benches) -> None:
    bench = marker_bench()
    bench.transform("map", "odom", (100.0, 0.0, 0.0), stamp_ns=SECOND)
    send(bench, cube(1, 1.0, "odom", stamp_ns=SECOND), cube(2, 2.0), cube(3, 0.0, "base"))
    bench.fixed_frame = "base"
    bench.turn()
    assert xs(bench) == [-8.0, 0.0, 91.0]


def test_zero_and_long_quaternions_are_normalised_and_reported(marker_bench: Benches) -> None:
    zero = cube(1, pose={"position": {}, "orientation": {"w": 0.0}}, scale={"x": 4, "y": 2, "z": 1})
    long = cube(2, pose={"position": {}, "orientation": {"z": 5.0, "w": 5.0}})
    bench = marker_bench([zero, long])
    (node,) = bench.nodes().values()
    turns = sorted(np.abs(node.wxyzs).tolist())
    np.testing.assert_allclose(turns, [(np.sqrt(0.5), 0, 0, np.sqrt(0.5)), (1, 0, 0, 0)], atol=1e-6)
    assert bench.statuses()["Orientation"][0] == "WARN"
    send(bench, cube(1), cube(2))
    assert "Orientation" not in bench.statuses()


# Namespaces


def test_a_namespace_that_is_off_keeps_its_markers(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0), cube(2, 2.0, ns="b")], namespaces={"b": False})
    assert xs(bench) == [1.0]
    send(bench, cube(2, 3.0, ns="b"))
    bench.set("namespaces", {})
    assert xs(bench) == [1.0, 3.0]
    bench.set("namespaces", {"a": False, "b": False})
    level, text = bench.statuses()["Markers"]
    assert (level, "2 in namespaces that are switched off (a, b)" in text) == ("WARN", True)
    bench.press("Markers")
    assert bench.nodes()


def test_namespaces_say_how_many_markers_they_have(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1), cube(2), cube(3, ns="")])
    bench.turn(1.5)
    statuses = bench.statuses()
    assert statuses["Namespace 'a'"] == ("OK", "2 markers, the newest 1.5 s ago.")
    assert statuses["Namespace ''"] == ("OK", "1 marker, the newest 1.5 s ago.")


# Statuses


@pytest.mark.parametrize(
    ("marker", "sentence"),
    [
        (cube(color={"r": 1.0}), "alpha"),
        (cube(scale={"x": 1.0, "z": 1.0}), "scale is 0 in y"),
        (cube(type=0, points=[{"x": 1.0}]), "one point"),
        (cube(type=5, points=[{}] * 3), "3 points"),
        (cube(type=6), "no points"),
        (cube(type=TEXT), "text is empty"),
        (cube(type=MESH), "names no mesh"),
        (cube(type=11, points=[{}] * 4), "4 points"),
        (cube(type=12, points=[{}]), "1 points"),
        (cube(type=8, points=[{}], colors=[{"r": 1.0}]), "every color"),
    ],
)
def test_an_invisible_marker_has_a_status(
    marker_bench: Benches, marker: dict[str, Any], sentence: str
) -> None:
    bench = marker_bench([marker])
    assert sentence in bench.statuses()["Marker a/0"][1]
    assert bench.statuses()["Markers"][0] == "WARN"


def test_statuses_are_bounded(marker_bench: Benches) -> None:
    bench = marker_bench([cube(i, color={}, ns=f"n{i}") for i in range(100)])
    statuses = bench.statuses()
    assert sum(key.startswith("Marker ") for key in statuses) == 10
    assert statuses["Other markers"] == ("WARN", "90 more are invalid or invisible.")
    assert statuses["Other namespaces"] == ("OK", "90 more.")


# Cost


def test_a_marker_that_changes_renews_the_nodes_of_its_block_only(marker_bench: Benches) -> None:
    bench = marker_bench([cube(i, 0.1 * i) for i in range(3 * BLOCK)])
    before = bench.nodes()
    send(bench, cube(BLOCK, -1.0))
    after = bench.nodes()
    assert [key for key in after if after[key] is not before[key]] == ["box in 1"]


def test_an_equal_message_redraws_nothing(marker_bench: Benches) -> None:
    texts = [cube(i, type=TEXT, text=f"t{i}") for i in range(9)]
    bench = marker_bench([*texts, cube(10, type=5, points=[{}, {"x": 1.0}])])
    before = bench.nodes()
    send(bench, *texts, cube(10, type=5, points=[{}, {"x": 1.0}]))
    after = bench.nodes()
    assert all(after[key] is before[key] for key in before)


def test_rows_and_nodes_are_used_again(marker_bench: Benches) -> None:
    bench = marker_bench()
    for step in range(60):
        send(bench, *(cube(i, 1.0 * i) for i in range(100 * step, 100 * step + 100)))
        send(bench, *(cube(i, action=DELETE) for i in range(100 * step, 100 * step + 100)))
    send(bench, cube(1, 7.0))
    assert xs(bench) == [7.0]
    assert len(bench.nodes()) == 1


def test_markers_far_away_keep_their_precision(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 500_000.0), cube(2, 500_000.001)])
    a, b = (
        (bench.xyz(key) for key in bench.nodes() for key in [key])
        if len(bench.nodes()) == 2
        else bench.xyz("box in 0")
    )
    assert abs(abs(b[0] - a[0]) - 0.001) < 2e-4


def test_markers_in_very_many_places_are_limited_and_the_rest_comes_when_there_is_room(
    marker_bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz_displays.markers.blocks.MAX_PLACES", 2)
    bench = marker_bench([cube(number, 1e5 * number) for number in range(4)])
    assert len(bench.nodes()) == 2
    assert bench.statuses()["Places"][1].startswith("2 markers left out")
    assert bench.statuses()["Markers"][1].startswith("2 of 4 markers shown")
    send(bench, cube(0, action=DELETE))
    assert len(bench.nodes()) == 2
    assert bench.statuses()["Places"][1].startswith("1 marker left out")
    send(bench, cube(1, action=DELETE))
    assert "Places" not in bench.statuses()
    assert bench.statuses()["Markers"][1].startswith("2 markers in")


# Topics


def test_marker_does_not_miss_single_ones_while_arrays_come(bench: Benches) -> None:
    at = bench(Marker())
    at.turn()
    assert "No publisher" in at.statuses()["Topic"][1]
    at.send(ARRAY, {"markers": [cube()]}, topic="/visualization_marker_array")
    at.turn()
    assert {level for level, _ in at.statuses().values()} == {"OK"}
    at.send(MARKER, cube(1), topic="/visualization_marker")
    at.turn()
    assert at.statuses()["Topic"][1].startswith("1 message")


def test_marker_takes_single_ones_and_arrays_of_the_topic_beside_it(bench: Benches) -> None:
    at = bench(Marker())
    at.send(MARKER, cube(1, 1.0), topic="/visualization_marker")
    at.send(ARRAY, {"markers": [cube(2, 2.0)]}, topic="/visualization_marker_array")
    at.turn()
    assert xs(at) == [1.0, 2.0]


def test_a_latched_message_that_comes_again_renews_lifetimes(bench: Benches) -> None:
    at = bench(MarkerArray())
    for _ in range(2):
        at.send(ARRAY, {"markers": [cube(1, 1.0, lifetime={"sec": 2})]})
        offer = at.offers["/visualization_marker_array"]
        at.offers["/visualization_marker_array"] = type(offer)(
            offer.publishers, ("reliable", "transient_local")
        )
        at.turn(1.5)
    assert xs(at) == [1.0]


def test_a_reset_forgets_all_markers(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1)])
    bench.runner.reset()
    bench.turn()
    assert xs(bench) == []


EXTREMES = (0.0, -1.0, 1e-308, 1e308, -1e308, math.inf, -math.inf, NAN)
POINTS = [{}, {"x": 1.0}, {"y": 1.0}]


def extremes(type_: int) -> list[dict[str, Any]]:
    """Markers of a type of which each has one number that no program should send."""
    variants = []
    for value in EXTREMES:
        short = float(np.float32(np.clip(value, -3e38, 3e38))) if math.isfinite(value) else value
        point, color = {"x": value}, {"r": short, "a": 1.0}
        variants += [
            {"pose": {"position": point, "orientation": {"w": 1.0}}},
            {"pose": {"orientation": {"z": value, "w": 1.0}}},
            {"scale": {"x": value, "y": 1.0, "z": value}},
            {"color": color},
            {"color": {"r": 1.0, "a": short}},
            {"points": [point, *POINTS[1:]]},
            {"colors": [color, color, {"a": short}]},
            {"uv_coordinates": [{"u": short}] * 3, "texture_resource": "embedded://a"},
        ]
    lifetimes = [{"sec": sec, "nanosec": 0xFFFF_FFFF} for sec in (-(2**31), 2**31 - 1)]
    variants += [{"lifetime": each} for each in lifetimes]
    variants += [{"stamp_ns": 2**31 * SECOND - 1}, {"frame": "/nowhere"}, {"frame": ""}]
    filled = {"type": type_, "points": POINTS, "text": "a", "mesh_resource": "package://no/a.stl"}
    return [cube(**(filled | each), id=i) for i, each in enumerate(variants)]


@pytest.mark.parametrize("is_locked", [False, True])
def test_extreme_numbers_draw_nothing_non_finite_and_leave_the_rest(
    marker_bench: Benches, is_locked: bool
) -> None:
    bench = marker_bench([cube(7, 1.0, ns="good")])
    for type_ in range(14):
        named = [each | {"ns": f"{type_}", "frame_locked": is_locked} for each in extremes(type_)]
        send(bench, *named)
        send(bench, *(each | {"id": each["id"] + 1} for each in named))
    assert 1.0 in xs(bench)
    for node in bench.nodes().values():
        for value in vars(node).values():
            if isinstance(value, np.ndarray) and value.dtype.kind == "f":
                assert np.isfinite(value).all()
    assert len(bench.statuses()) < 60
    send(bench, {"action": DELETEALL})
    assert not bench.nodes()


def test_very_many_markers_and_very_long_texts_are_limited(
    marker_bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz_displays.markers.store.MAX_MARKERS", 300)
    monkeypatch.setattr("webviz_displays.markers.report.MAX_TEXTS", 3)
    long = cube(1, type=TEXT, text="ab\n" * 3_000_000)
    bench = marker_bench([long, cube(2, 1.0)], [cube(i, ns="b") for i in range(400)])
    assert len(xs(bench)) == 300
    statuses = bench.statuses()
    assert "101 markers refused" in statuses["Limit"][1]
    assert "has 9000000 characters" in statuses["Marker a/1"][1]
    send(bench, *(cube(i, ns="b", type=TEXT, text="a") for i in range(4)))
    assert "show 3 of all texts; these are 4" in bench.statuses()["Texts"][1]


def test_undecodable_bytes_leave_the_other_markers(marker_bench: Benches) -> None:
    bench = marker_bench([cube(1, 1.0)])
    bench.send_bytes(ARRAY, b"\0\1\0\0\xff\xff\xff\xff", "/visualization_marker_array")
    bench.turn()
    assert xs(bench) == [1.0]
    assert bench.statuses()["Message"][0] == "ERROR"


class TestMarker(BuiltInChecks):
    display = Marker
    messages: ClassVar = {}
    scene = markers_of_both_kinds


class TestMarkerArray(BuiltInChecks):
    display = MarkerArray
    messages: ClassVar = {}
    scene = markers_of_both_kinds


def marker(
    bench: Benches, key: str, number: int | None, point: Any = None, **fields: Any
) -> Details:
    """An item of the second of two markers, 10 m behind the first."""
    each = {"scale": {"x": 1.0, "y": 1.0, "z": 1.0}, "color": {"g": 1.0, "a": 1.0}, **fields}
    header = {"frame_id": "odom"}
    near, far = ({"pose": {"position": {"x": x}}} for x in (0.0, 10.0))
    markers = [{**each, **pose, "header": header, "ns": "a", "id": i}
               for i, pose in enumerate((near, far))]  # fmt: skip
    at = bench(MarkerArray())
    at.transform("map", "odom")
    at.send("visualization_msgs/msg/MarkerArray", {"markers": markers})
    at.turn()
    at.settle()
    (node,) = (name for name in at.nodes() if name.startswith(key))
    return at.pick(node, number, point)


TRIANGLES = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 1), (0, 0, 2)], np.float64)
COLORFUL = {"points": TRIANGLES, "colors": np.array([(1, 0, 0, 1)] * 6, np.float32)}
CORNERS = {"points": np.arange(9.0).reshape(3, 3)}


def textured() -> dict[str, Any]:
    """Fields of triangles with a picture."""
    png = io.BytesIO()
    PIL.Image.new("RGB", (2, 2)).save(png, "png")
    texture = {"format": "png", "data": png.getvalue()}
    uvs = np.zeros((6, 2), np.float32)
    more = {"texture_resource": "embedded://a.png", "texture": texture, "uv_coordinates": uvs}
    return {"points": TRIANGLES, **more}


@pytest.mark.parametrize(
    ("kind", "key", "number", "fields", "values"),
    [
        (1, "box", 1, {}, {"Namespace": "a", "Id": "1", "Type": "CUBE", "Frame": "odom"}),
        (8, "points", 4, CORNERS, {"Type": "POINTS", "Points": "3"}),
        (4, "lines", 3, CORNERS, {"Type": "LINE_STRIP", "Age": "0.0 s"}),
        (11, "triangles", None, {"points": TRIANGLES}, {"Type": "TRIANGLE_LIST", "Points": "6"}),
        (11, "colorful", None, COLORFUL, {"Type": "TRIANGLE_LIST"}),
        (11, "triangles 2", None, textured(), {"Type": "TRIANGLE_LIST"}),
        (9, "texts", 1, {"text": "Dock"}, {"Type": "TEXT_VIEW_FACING", "Text": "Dock"}),
    ],
    ids=["shape", "point", "line", "triangle", "colorful triangle", "texture", "text"],
)
def test_selecting_item_of_a_marker(
    bench: Benches,
    kind: int,
    key: str,
    number: int | None,
    fields: dict[str, Any],
    values: dict[str, str],
) -> None:
    """The triangles of two markers are one mesh, with one that has no area."""
    point = (10.2, 0.3, 0.0) if number is None else None
    check_details(marker(bench, key, number, point, type=kind, **fields), "Marker a/1", values)
