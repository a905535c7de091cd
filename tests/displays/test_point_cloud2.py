from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from clouds import CLOUD, FLOAT32, UINT32, XYZ, cloud, xyz_cloud
from display_scenes import clouds
from hypothesis import given, settings
from hypothesis import strategies as st
from inspecting import QUARTER, Benches, check_empty, colors

from webviz.api.nodes import Instances, Lines, Points
from webviz.data.messages import encode
from webviz.shell.testing import check_details
from webviz.shell.testing.messages import header
from webviz_displays.point_cloud2 import PointCloud2
from webviz_displays.point_cloud2.decimation import evenly, one_per_voxel
from webviz_displays.point_cloud2.display import spaced
from webviz_displays.shared import points_display

SECOND = 1_000_000_000
NAN, INF = float("nan"), float("inf")
RED, MIDDLE, MAGENTA = [255, 0, 0], [0, 255, 128], [255, 0, 255]
THREE = [(1.0, 0.0, 0.0), (2.0, 0.0, 5.0), (3.0, 0.0, 10.0)]


@pytest.fixture
def lab(sensed: Benches) -> Callable[..., Any]:
    """Make a bench that has drawn one cloud."""
    return lambda values, **properties: sensed(PointCloud2(**properties), values)


def rgb(*numbers: int) -> list[float]:
    """0xAARRGGBB as the floats with the same bytes."""
    return np.array(numbers, np.uint32).view(np.float32).tolist()


# Which points


def test_points_lie_in_the_frame_of_the_sensor(lab: Benches) -> None:
    bench = lab(xyz_cloud(THREE))
    np.testing.assert_allclose(bench.xyz("points"), np.add(THREE, (0, 0, 1)), atol=1e-6)
    assert bench.statuses()["Points"] == ("OK", "Showing 3 of 3 points.")


@pytest.mark.parametrize("is_dense", [False, True])
def test_non_finite_points_are_dropped_regardless_of_is_dense(lab: Benches, is_dense: bool) -> None:
    points = [(1, 2, 3), (NAN, 0, 0), (0, INF, 0), (4, 5, 6), (0, 0, 1e12)]
    values = xyz_cloud(points, {"intensity": [10, 0, 0, 20, 0]}) | {"is_dense": is_dense}
    bench = lab(values)
    np.testing.assert_allclose(bench.xyz("points"), [(1, 2, 4), (4, 5, 7)])
    assert colors(bench) == [RED, MAGENTA]
    assert bench.statuses()["Points"] == (
        "OK",
        "Showing 2 of 5 points; dropped: 3 not finite or farther than 1e9 m.",
    )


@pytest.mark.parametrize(
    ("values", "level", "words"),
    [
        (xyz_cloud([(NAN, NAN, NAN)]), "WARN", "Showing 0 of 1 points; dropped: 1 not finite"),
        (xyz_cloud(THREE) | {"width": 0, "data": []}, "WARN", "empty: width x height is 0"),
        (xyz_cloud(THREE) | {"height": 0}, "WARN", "empty: width x height is 0"),
        (xyz_cloud(THREE) | {"data": []}, "ERROR", "0 bytes, but 3 x 1 points of 12 bytes need 36"),
        (xyz_cloud(THREE) | {"fields": []}, "ERROR", "no field 'x'; its fields are: none"),
    ],
)
def test_a_cloud_without_points_has_a_status(
    lab: Benches, values: dict[str, Any], level: str, words: str
) -> None:
    bench = lab(values)
    check_empty(bench, level, words)


@pytest.mark.parametrize("byte", [1, 255])
def test_a_little_endian_cloud_that_claims_to_be_big_endian_is_refused(
    lab: Benches, byte: int
) -> None:
    bench = lab(xyz_cloud([(0.0, 0.0, 0.0)]), decay_time=1.0)
    values = {**xyz_cloud(THREE), "header": header("sensor", bench.now_ns)}
    little, big = (encode(CLOUD, {**values, "is_bigendian": flag}) for flag in (False, True))
    (place,) = (i for i in range(len(big)) if big[i] != little[i])
    bench.send_bytes(CLOUD, big[:place] + bytes([byte]) + big[place + 1 :])
    bench.turn()
    level, text = bench.statuses()["Points"]
    assert level == "ERROR"
    assert text.startswith("is_bigendian is set, but x, y and z make sense in little-endian order")
    assert sum(len(node.xyz) for node in bench.nodes().values()) == 1


def test_odd_sizes_are_shown_with_a_warning(lab: Benches) -> None:
    bench = lab(xyz_cloud(THREE) | {"width": 2, "row_step": 24})
    assert len(bench.xyz("points")) == 2
    level, text = bench.statuses()["Data"]
    assert level == "WARN"
    assert "The data has 36 bytes, 24 were enough for 2 x 1 points of 12 bytes" in text


def test_an_organised_cloud_with_padded_rows_is_drawn_whole(lab: Benches) -> None:
    points = [{"x": [i], "y": [10 * i], "z": [0]} for i in range(6)]
    bench = lab(cloud(XYZ, points, height=2, row_padding=7))
    expected = [(i, 10 * i, 1) for i in range(6)]
    np.testing.assert_allclose(bench.xyz("points"), expected)


def test_far_clouds_keep_their_millimetres(bench: Benches) -> None:
    at = bench(PointCloud2(), fixed_frame="utm")
    fields = [("x", 0, 8, 1), ("y", 8, 8, 1), ("z", 16, 8, 1)]
    places = [(500_000.001 + i / 1000, 5_400_000.002, 100.0) for i in range(5)]
    points = [{"x": [x], "y": [y], "z": [z]} for x, y, z in places]
    at.transform("utm", "survey", (3.0, 0.0, 0.0))
    at.send(CLOUD, cloud(fields, points), frame="survey")
    at.turn()
    np.testing.assert_allclose(at.xyz("points"), np.add(places, (3, 0, 0)), rtol=0, atol=1e-4)
    assert np.abs(at.nodes()["points"].xyz).max() < 2000


def test_far_clouds_follow_a_new_fixed_frame(bench: Benches) -> None:
    at = bench(PointCloud2(), fixed_frame="utm")
    at.transform("utm", "site", (500_000.0, 0.0, 0.0))
    fields = [("x", 0, 8, 1), ("y", 8, 8, 1), ("z", 16, 8, 1)]
    at.send(CLOUD, cloud(fields, [{"x": [500_007.5], "y": [0], "z": [0]}]), frame="utm")
    at.turn()
    at.fixed_frame = "site"
    at.turn()
    np.testing.assert_allclose(at.xyz("points"), [(7.5, 0, 0)], atol=1e-4)


def test_points_over_the_limit_are_thinned_evenly_and_reported(lab: Benches) -> None:
    points = np.stack((np.arange(1000), np.zeros(1000), np.zeros(1000)), axis=1)
    bench = lab(xyz_cloud(points.tolist(), {"intensity": [float(i) for i in range(1000)]}))
    bench.set("max_points", 100)
    xs = bench.xyz("points")[:, 0]
    assert len(xs) == 100
    assert (np.floor(xs / 10) == np.arange(100)).all()
    assert len(colors(bench)) == 100
    assert bench.statuses()["Points"] == (
        "OK",
        "Showing 100 of 1 000 points; dropped: 900 over max_points of 100.",
    )
    bench.set("max_points", 0)
    assert len(bench.xyz("points")) == 1000


def test_as_many_points_as_browsers_hold_are_shown_and_all_of_a_cloud_at_rest(lab: Benches) -> None:
    points = np.random.default_rng(0).random((1000, 3))
    bench = lab(xyz_cloud(points.tolist()), color_transformer="FlatColor")
    assert len(bench.xyz("points")) == 1000
    bench.scene.max_points = 200
    bench.turn(0.1)
    assert len(bench.xyz("points")) == 200
    assert bench.statuses()["Points"][1] == (
        "Showing 200 of 1 000 points; dropped: 800 over the 200 that browsers hold at 20 frames a "
        "second."
    )
    bench.turn(3.5)
    (points_node,) = bench.nodes().values()
    assert points_node.thins, "every browser draws as many of them as it holds"
    assert sorted(points_node.ids) == list(range(1000))
    expected = np.add(points, (0, 0, 1))[points_node.ids]
    np.testing.assert_allclose(bench.xyz("blocks"), expected, atol=1e-6)
    assert bench.statuses()["Points"][1] == (
        "Showing 1 000 of 1 000 points; browsers thin out distant ones to keep 20 frames a second."
    )
    bench.scene.max_points = 400
    bench.turn(1.0)
    assert bench.nodes() == {"blocks": points_node}, "is not sent again"
    bench.send(CLOUD, xyz_cloud(points.tolist()), frame="sensor")
    bench.turn()
    bench.turn()
    assert {key: len(node.xyz) for key, node in bench.nodes().items()} == {"points": 400}
    bench.set("max_points", 0)
    assert len(bench.xyz("points")) == 1000, "whatever browsers hold"


def test_one_point_per_voxel_is_shown_and_reported(lab: Benches) -> None:
    points = [(0.01, 0, 0), (0.02, 0, 0), (-0.01, 0, 0), (NAN, 0, 0), (0.11, 0, 0)]
    bench = lab(xyz_cloud(points), voxel_size=0.1)
    np.testing.assert_allclose(bench.xyz("points")[:, 0], [0.01, -0.01, 0.11], atol=1e-6)
    assert bench.statuses()["Points"][1] == (
        "Showing 3 of 5 points; dropped: 1 not finite or farther than 1e9 m, "
        "1 in voxels of 0.1 m that already show a point."
    )


@settings(deadline=None)
@given(
    st.lists(st.tuples(*[st.integers(-5, 5)] * 3), max_size=60),
    st.sampled_from([0.5, 1.0, 3.0]),
)
def test_voxels_are_those_of_a_slow_reader(points: list[tuple[int, int, int]], size: float) -> None:
    first: dict[tuple[float, ...], int] = {}
    for row, point in enumerate(points):
        first.setdefault(tuple(v // size for v in point), row)
    rows = one_per_voxel(np.array(points, np.float32).reshape(-1, 3), size)
    assert rows.tolist() == sorted(first.values())


def test_many_points_share_few_voxels_exactly() -> None:
    xyz = np.random.default_rng(1).uniform(-50, 50, (100_000, 3)).astype(np.float32)
    voxels, first = np.unique(np.floor(xyz / 2.5), axis=0, return_index=True)
    rows = one_per_voxel(xyz, 2.5)
    assert len(rows) == len(voxels)
    assert rows.tolist() == sorted(first.tolist())


@settings(deadline=None)
@given(st.integers(2, 5000), st.data())
def test_picked_rows_are_one_of_each_equal_part(total: int, data: st.DataObject) -> None:
    limit = data.draw(st.integers(1, total - 1))
    rows = evenly(total, limit)
    edges = [i * total // limit for i in range(limit + 1)]
    assert len(rows) == limit
    assert all(low <= row < high for low, row, high in zip(edges, rows, edges[1:], strict=False))


def test_numbers_are_written_with_spaces() -> None:
    assert [spaced(n) for n in (7, 1000, 1_000_000)] == ["7", "1 000", "1 000 000"]


# Colours


def test_a_colour_in_the_cloud_is_shown_by_default(lab: Benches) -> None:
    packed = rgb(0xFF102030, 0x00FFFEFD, 0x7F000001)
    bench = lab(xyz_cloud(THREE, {"intensity": [1, 2, 3], "rgb": packed}))
    assert colors(bench) == [[16, 32, 48], [255, 254, 253], [0, 0, 1]]
    assert bench.statuses()["Colors"][1] == "RGB8, by the fields: x, y, z, intensity, rgb."


@pytest.mark.parametrize("name", ["intensity", "intensities"])
def test_without_a_colour_intensity_is_shown(lab: Benches, name: str) -> None:
    assert colors(lab(xyz_cloud(THREE, {name: [5, 10, 15]}))) == [RED, MIDDLE, MAGENTA]


def test_with_neither_red_green_and_blue_are_shown(lab: Benches) -> None:
    values = xyz_cloud(THREE, {"r": [0, 0.5, 2], "g": [1, 0, NAN], "b": [0, 0, -1]})
    assert colors(lab(values)) == [[0, 255, 0], [128, 0, 0], [255, 0, 0]]


def test_a_cloud_of_places_only_is_coloured_by_height(lab: Benches) -> None:
    bench = lab(xyz_cloud(THREE))
    assert colors(bench) == [RED, MIDDLE, MAGENTA]
    assert bench.statuses()["Colors"][1] == "AxisColor, by the fields: x, y, z."


def test_red_green_and_blue_as_integers_go_to_255(lab: Benches) -> None:
    fields = [*XYZ, *((name, 12 + i, 2, 1) for i, name in enumerate("rgb"))]
    point = {"x": [0], "y": [0], "z": [0], "r": [255], "g": [1], "b": [128]}
    assert colors(lab(cloud(fields, [point]), color_transformer="RGBF32")) == [[255, 1, 128]]


def test_the_alpha_of_rgba_fades_points_and_hides_those_of_0(lab: Benches) -> None:
    packed = rgb(0xFFF83000, 0x00FFFFFF, 0x80F83000)
    bench = lab(xyz_cloud(THREE, {"rgba": packed}))
    nodes = bench.nodes()
    by_opacity = {
        node.opacity: (node.xyz[:, 0].tolist(), node.ids.tolist()) for node in nodes.values()
    }
    assert by_opacity == {1.0: ([1], [0]), 128 / 255: ([3], [2])}
    assert {tuple(color) for node in nodes.values() for color in node.colors} == {(248, 48, 0)}
    level, text = bench.statuses()["Points"]
    assert level == "OK"
    assert "1 of them are invisible: their rgba has alpha 0." in text


def test_a_cloud_of_alpha_0_warns(lab: Benches) -> None:
    bench = lab(xyz_cloud(THREE, {"rgba": rgb(0xFFFFFF, 0, 1)}))
    assert bench.statuses()["Points"][0] == "WARN"


@pytest.mark.parametrize("channel", ["x", "z", "ring"])
def test_any_field_can_be_coloured(lab: Benches, channel: str) -> None:
    bench = lab(
        xyz_cloud(THREE, {"ring": [7, 8, 9]}), color_transformer="Intensity", channel_name=channel
    )
    assert colors(bench) == [RED, MIDDLE, MAGENTA]


def test_a_field_with_several_elements_is_coloured_by_its_first(lab: Benches) -> None:
    fields = [*XYZ, ("normal", 12, FLOAT32, 3)]
    points = [{"x": [i], "y": [0], "z": [0], "normal": [i, 99 - i, 5]} for i in range(3)]
    bench = lab(cloud(fields, points), color_transformer="Intensity", channel_name="normal")
    assert colors(bench) == [RED, MIDDLE, MAGENTA]


def test_signed_fields_have_their_sign(lab: Benches) -> None:
    fields = [*XYZ, ("level", 12, 3, 1)]
    points = [{"x": [0], "y": [0], "z": [0], "level": [v]} for v in (-100, 0, 100)]
    bench = lab(cloud(fields, points), color_transformer="Intensity", channel_name="level")
    assert colors(bench) == [RED, MIDDLE, MAGENTA]


@pytest.mark.parametrize(
    ("transformer", "words"),
    [
        ("Intensity", "The cloud has no field 'intensity'; its fields are: x, y, z, t."),
        ("RGB8", "The cloud has no field 'rgb'; its fields are: x, y, z, t."),
        ("RGBF32", "The cloud has no field 'r'; its fields are: x, y, z, t."),
    ],
)
def test_without_the_field_points_are_white_and_the_fields_there_are_are_named(
    lab: Benches, transformer: str, words: str
) -> None:
    bench = lab(xyz_cloud(THREE, {"t": [1, 2, 3]}), color_transformer=transformer)
    assert bench.nodes()["points"].colors == (255, 255, 255)
    assert bench.statuses()["Colors"] == ("WARN", f"{words} The points are white.")
    bench.press("Colors")


def test_a_status_names_only_the_first_of_many_fields(lab: Benches) -> None:
    bench = lab(
        cloud([(f"{number:04}".ljust(50, "f"), 0, FLOAT32, 1) for number in range(5000)], [])
    )
    text = bench.statuses()["Points"][1]
    assert text.endswith("and 4980 more.")
    assert len(text) < 1000


def test_a_colour_that_is_not_of_four_bytes_is_refused_in_words(lab: Benches) -> None:
    fields = [*XYZ, ("rgb", 12, 8, 1)]
    bench = lab(cloud(fields, [{"x": [0], "y": [0], "z": [0], "rgb": [1.0]}]))
    text = "Field 'rgb' is float64; a packed colour has 4 bytes. The points are white."
    assert bench.statuses()["Colors"] == ("WARN", text)


def test_axis_colours_are_of_the_fixed_frame_or_of_the_sensor(bench: Benches) -> None:
    at = bench(PointCloud2(color_transformer="AxisColor"))
    # The sensor lies on its side: its y points up.
    at.transform("map", "sensor", (0, 0, 0), (np.sqrt(0.5), 0, 0, np.sqrt(0.5)))
    at.send(CLOUD, xyz_cloud([(0, -1, 3), (0, 0, 2), (0, 1, 1)]), frame="sensor")
    at.turn()
    assert colors(at) == [RED, MIDDLE, MAGENTA]
    at.set("use_fixed_frame", False)
    assert colors(at) == [MAGENTA, MIDDLE, RED]


def test_axis_bounds_hold_far_from_the_origin_too(lab: Benches) -> None:
    values = xyz_cloud([(9000 + v, 0, 0) for v in (0, 5, 10)])
    limits = {"value": False, "min_value": 9000.0, "max_value": 9010.0}
    bench = lab(values, color_transformer="AxisColor", axis="X")
    bench.set("autocompute_value_bounds", limits)
    assert colors(bench) == [RED, MIDDLE, MAGENTA]
    bench.set("use_fixed_frame", False)
    assert colors(bench) == [RED, MIDDLE, MAGENTA]


# Styles and time


def test_solids_are_lit(lab: Benches) -> None:
    bench = lab(xyz_cloud(THREE), style="Boxes", size=0.2, alpha=0.5)
    node = bench.nodes()["solids"]
    assert isinstance(node, Instances)
    assert (node.shape, node.opacity) == ("box", 0.5)
    np.testing.assert_allclose(bench.xyz("solids"), np.add(THREE, (0, 0, 1)))


def test_boxes_turn_with_the_frame_of_the_cloud(bench: Benches) -> None:
    at = bench(PointCloud2(style="Boxes"))
    tilt = (0.5, 0.5, 0.5, 0.5)
    at.transform("map", "sensor", (1.0, 0.0, 0.0), tilt)
    at.send(CLOUD, xyz_cloud(THREE), frame="sensor")
    at.turn()
    np.testing.assert_allclose(at.nodes()["solids"].wxyzs, [tilt] * 3, atol=1e-6)


@pytest.mark.parametrize(
    ("style", "outline", "words"),
    [("Boxes", "square", "squares that face"), ("Spheres", "circle", "discs that face")],
)
def test_solids_over_the_limit_are_drawn_flat_with_a_warning(
    lab: Benches, monkeypatch: pytest.MonkeyPatch, style: str, outline: str, words: str
) -> None:
    monkeypatch.setattr(points_display, "SOLIDS_LIMIT", 2)
    bench = lab(xyz_cloud(THREE), style=style)
    node = bench.nodes()["points"]
    assert isinstance(node, Points)
    assert (node.shape, len(node.xyz)) == (outline, 3)
    text = bench.statuses()["Style"][1]
    assert words in text
    assert "the limit is 2 solids, got 3" in text


def test_dots_are_so_many_pixels_wide_and_limited(
    lab: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz_displays.point_cloud2.display.DOTS_LIMIT", 2)
    bench = lab(xyz_cloud(THREE), style="Points", size_pixels=4.0)
    node = bench.nodes()["points"]
    assert isinstance(node, Lines)
    assert (node.width, node.unit, len(node.segments)) == (4.0, "px", 2)
    assert "1 over the limit of the style Points of 2" in bench.statuses()["Points"][1]


def test_clouds_stay_for_the_decay_time(lab: Benches) -> None:
    bench = lab(xyz_cloud(THREE), decay_time=2.0)
    bench.turn(1.5)
    bench.send(CLOUD, xyz_cloud(THREE[:1]), frame="sensor")
    bench.turn()
    assert sorted(len(node.xyz) for node in bench.nodes().values()) == [1, 3]
    bench.turn(1.0)
    assert [len(node.xyz) for node in bench.nodes().values()] == [1]


def test_clouds_of_the_decay_time_share_the_limit_of_points(lab: Benches) -> None:
    cloud = xyz_cloud(np.random.default_rng(0).random((1000, 3)).tolist())
    bench = lab(cloud, decay_time=10.0, max_points=800)
    counts = []
    for _ in range(7):
        bench.turn(0.1)
        bench.send(CLOUD, cloud, frame="sensor")
        bench.turn()
        counts.append(sum(len(node.xyz) for node in bench.nodes().values()))
    assert max(counts) <= 800
    assert [len(node.xyz) for node in bench.nodes().values()] == [100] * 8
    assert bench.statuses()["Points"][1] == (
        "Showing 100 of 1 000 points; dropped: 900 over max_points of 800 for 8 clouds."
    )
    bench.turn(10.05)
    bench.send(CLOUD, cloud, frame="sensor")
    bench.turn()
    bench.set("decay_time", 0.0)
    bench.turn()
    assert [len(node.xyz) for node in bench.nodes().values()] == [800]


def test_a_cloud_waits_for_its_transform(bench: Benches) -> None:
    at = bench(PointCloud2())
    at.transform("map", "sensor", (0.0, 0.0, 0.0), stamp_ns=at.now_ns - SECOND)
    at.send(CLOUD, xyz_cloud(THREE), frame="sensor")
    at.turn()
    assert not at.nodes()
    at.transform("map", "sensor", (0.0, 0.0, 5.0), stamp_ns=at.now_ns)
    at.turn()
    np.testing.assert_allclose(at.xyz("points")[0], (1, 0, 5))


def test_voxels_have_a_least_size() -> None:
    xyz = np.array([[0.0, 0.0, 0.0], [0.00005, 0.0, 0.0], [0.00015, 0.0, 0.0]], np.float32)
    assert one_per_voxel(xyz, 0.0).tolist() == [0, 2]


class TestPointCloud2(BuiltInChecks):
    display = PointCloud2
    scene = clouds
    variants = (
        PointCloud2,
        lambda: PointCloud2(color_transformer="RGB8", style="Points", decay_time=1.0),
        lambda: PointCloud2(color_transformer="AxisColor", style="Boxes", voxel_size=0.1),
    )
    needs: ClassVar = {"max_points": {"max_points": 3}}


def test_selecting_point_of_a_cloud(bench: Benches) -> None:
    """The third that is drawn, of a cloud in rows, whose first two and fifth cannot be."""
    names = [*XYZ, ("intensity", 12, FLOAT32, 1), ("rgb", 16, UINT32, 1), ("ring", 20, 4, 2)]
    places = [(math.nan, 0, 0), (0, math.nan, 0), (1, 2, 3), (4, 5, 6), (2e9, 0, 0), (7, 8, 0.1)]
    points = [
        {
            **{axis: [value] for axis, value in zip("xyz", place, strict=True)},
            "intensity": [0.1 * i],
            "rgb": [0x00010203 + i],
            "ring": [i, 2 * i],
        }
        for i, place in enumerate(places)
    ]
    at = bench(PointCloud2())
    at.transform("map", "sensor", (0.0, 0.0, 2.0), QUARTER)
    at.send(CLOUD, cloud(names, points, height=2, row_padding=5), frame="sensor")
    at.turn()
    check_details(
        at.pick("points", 2),
        "Point 5",
        {
            "intensity": "0.5",
            "rgb": "r 1, g 2, b 8",
            "ring": "5, 10",
            "Row": "1",
            "Column": "2",
            "Position in sensor": {"fields": {"x": "7.0", "y": "8.0", "z": "0.1"}},
        },
    )


def test_selecting_point_of_a_thinned_cloud(bench: Benches) -> None:
    points = [{"x": [float(i)], "y": [0.0], "z": [0.0], "i": [i]} for i in range(100)]
    at = bench(PointCloud2(max_points=10, style="Boxes", color_transformer="FlatColor"))
    at.transform("map", "sensor")
    at.send(CLOUD, cloud([*XYZ, ("i", 12, UINT32, 1)], points), frame="sensor")
    at.turn()
    details = at.pick("solids", 4)
    number = details.values["i"]
    assert number in range(40, 50)
    check_details(details, f"Point {number}", {"Points in the cloud": "100"})


def test_selecting_invisible_points_do_not_count(bench: Benches) -> None:
    """An rgba with alpha 0 hides the first."""
    names = [*XYZ, ("rgba", 12, UINT32, 1)]
    points = [
        {"x": [1.0], "y": [0.0], "z": [0.0], "rgba": [0x00FF0000]},
        {"x": [2.0], "y": [0.0], "z": [0.0], "rgba": [0xFF00FF00]},
    ]
    at = bench(PointCloud2())
    at.transform("map", "sensor")
    at.send(CLOUD, cloud(names, points), frame="sensor")
    at.turn()
    check_details(at.pick("points", 0), "Point 1", {"rgba": "r 0, g 255, b 0, a 255"})
