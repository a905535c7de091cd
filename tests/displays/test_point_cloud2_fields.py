"""Clouds of any layout, read as a slow and obvious reader reads them."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest
from clouds import CLOUD, CODES, FLOAT32, XYZ, cloud, xyz_cloud
from hypothesis import given, settings
from hypothesis import strategies as st

from webviz.data import messages
from webviz.data.messages import encode
from webviz_displays.point_cloud2.cloud import Cloud, CloudError, drawable
from webviz_displays.point_cloud2.cloud_colors import packed_colors

FLOATS = {7: st.floats(width=32), 8: st.floats(width=64)}
NEAR = {7: st.floats(-500, 500, width=32), 8: st.floats(-500, 500)}


def decoded(values: dict[str, Any]) -> messages.PointCloud2:
    return messages.decode(CLOUD, encode(CLOUD, values))


def numbers(kind: int, floats: dict[int, Any]) -> st.SearchStrategy[Any]:
    if kind in floats:
        return floats[kind]
    bits = 8 * struct.calcsize(CODES[kind])
    low = -(1 << (bits - 1)) if CODES[kind].islower() else 0
    return st.integers(low, low + (1 << bits) - 1)


@st.composite
def layouts(draw: st.DrawFn) -> tuple[dict[str, Any], list[dict[str, list[Any]]]]:
    """A cloud and its points: fields of any type, order, count and distance."""
    names = draw(st.permutations(["x", "y", "z", "intensity", "ring", "normal"]))
    fields = []
    offset = 0
    for name in names:
        kind = draw(st.sampled_from([7, 8] if name in "xyz" else sorted(CODES)))
        count = draw(st.integers(1, 3))
        offset += draw(st.integers(0, 3))
        fields.append((name, offset, kind, count))
        offset += struct.calcsize(CODES[kind]) * count
    height, width = draw(st.integers(1, 3)), draw(st.integers(1, 4))
    points = []
    for _ in range(height * width):
        point = {}
        for name, _, kind, count in fields:
            usual = numbers(kind, NEAR if name in "xyz" else FLOATS)
            point[name] = draw(st.lists(usual, min_size=count, max_size=count))
        points.append(point)
    message = cloud(
        fields,
        points,
        height=height,
        point_step=offset + draw(st.integers(0, 5)),
        row_padding=draw(st.integers(0, 9)),
        is_bigendian=draw(st.booleans()),
    )
    return message, points


@settings(deadline=None)
@given(layouts())
def test_any_layout_is_read_as_a_slow_reader_reads_it(
    layout: tuple[dict[str, Any], list[dict[str, list[Any]]]],
) -> None:
    values, points = layout
    read = Cloud(decoded(values))
    xyz, origin = read.positions()
    expected = [[point[name][0] for name in "xyz"] for point in points]
    np.testing.assert_allclose(xyz + np.array(origin), expected, rtol=1e-6, atol=1e-4)
    for name in ("intensity", "ring", "normal"):
        np.testing.assert_array_equal(read.values(name), [point[name][0] for point in points])
    assert not read.remark


@settings(deadline=None)
@given(st.lists(st.tuples(*[st.floats(width=32)] * 3), max_size=8))
def test_points_are_drawn_if_every_coordinate_is_a_number_within_reach(
    points: list[tuple[float, float, float]],
) -> None:
    xyz = np.array(points, np.float32).reshape(-1, 3)
    rows = drawable(xyz)
    expected = [i for i, point in enumerate(points) if all(abs(v) < 1e9 for v in point)]
    assert (list(range(len(points))) if rows is None else rows.tolist()) == expected


@settings(deadline=None)
@given(st.binary(min_size=32, max_size=32), st.booleans())
def test_arbitrary_bytes_are_read_or_refused(data: bytes, is_bigendian: bool) -> None:
    """Any bits may come, signalling NaNs among them."""
    values = xyz_cloud([(0, 0, 0)] * 2, {"rgb": [0, 0]})
    values |= {"data": np.frombuffer(data, np.uint8), "is_bigendian": is_bigendian}
    read = Cloud(decoded(values))
    try:
        xyz, _ = read.positions()
    except CloudError:
        if is_bigendian:  # bytes that make sense only without the flag are refused
            return
        raise
    drawable(xyz)
    assert packed_colors(read, None)[0].shape == (2, 3)


@pytest.mark.parametrize("kind", [1, 2, 3, 4, 5, 6, 8])
def test_coordinates_may_have_any_type(kind: int) -> None:
    size = struct.calcsize(CODES[kind])
    fields = [("z", 0, kind, 1), ("x", size, kind, 1), ("y", 2 * size, kind, 1)]
    read = Cloud(decoded(cloud(fields, [{"x": [1], "y": [2], "z": [3]}])))
    xyz, origin = read.positions()
    assert xyz.dtype == np.float32
    assert (xyz.tolist(), origin) == ([[1, 2, 3]], (0, 0, 0))


def test_far_from_the_origin_nothing_is_lost_to_float32() -> None:
    fields = [("x", 0, 8, 1), ("y", 8, 8, 1), ("z", 16, 8, 1)]
    places = [(500_000.001, 5_400_000.002, 123.003), (500_010.5, 5_400_020.25, 123.0)]
    points = [{"x": [x], "y": [y], "z": [z]} for x, y, z in places]
    xyz, origin = Cloud(decoded(cloud(fields, points))).positions()
    assert origin == (500_000, 5_400_000, 0)
    np.testing.assert_allclose(xyz + np.array(origin), np.array(places), rtol=0, atol=2e-5)


def test_one_wild_point_does_not_move_the_origin() -> None:
    points = [(9e8, 0.0, 0.0), *[(5000.25, 0.0, 0.0)] * 9]
    xyz, origin = Cloud(decoded(xyz_cloud(points))).positions()
    assert origin == (5000, 0, 0)
    assert xyz[1:].tolist() == [[0.25, 0, 0]] * 9


def test_reading_the_usual_layout_copies_nothing_but_the_points() -> None:
    message = decoded(xyz_cloud([(1, 2, 3)] * 4, {"intensity": [1, 2, 3, 4]}))
    read = Cloud(message)
    xyz, _ = read.positions()
    assert np.shares_memory(read.values("intensity"), message.data)
    assert (xyz.flags.c_contiguous, xyz.nbytes) == (True, 48)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"data": np.zeros(47, np.uint8)},
            "The data has 47 bytes, but 4 x 1 points of 12 bytes need 48.",
        ),
        (
            {"height": 3, "row_step": 50, "data": np.zeros(147, np.uint8)},
            "The data has 147 bytes, but 4 x 3 points of 12 bytes need 148.",
        ),
        ({"width": 2**32 - 1, "height": 2**32 - 1}, "The data has 48 bytes, but"),
        ({"point_step": 0}, "point_step is 0, but the cloud has 4 points."),
        ({"point_step": 11}, "Field 'z' takes bytes 8 to 12 of each point, but point_step is 11."),
        ({"fields": []}, "The cloud has no field 'x'; its fields are: none."),
    ],
)
def test_inconsistent_sizes_are_reported_with_both_numbers(
    changes: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(CloudError, match="^" + sentence.replace("'", ".").replace(".", "[.']?")):
        Cloud(decoded(xyz_cloud([(1, 2, 3)] * 4) | changes)).positions()


@pytest.mark.parametrize("missing", ["x", "y", "z"])
def test_a_missing_coordinate_is_named_with_the_fields_there_are(missing: str) -> None:
    fields = [field for field in XYZ if field[0] != missing]
    rest = ", ".join(name for name, *_ in fields)
    with pytest.raises(CloudError, match=f"no field '{missing}'; its fields are: {rest}"):
        Cloud(decoded(cloud(fields, [{"x": [1], "y": [1], "z": [1]}]))).positions()


def test_an_unknown_datatype_is_named() -> None:
    values = xyz_cloud([(1, 2, 3)])
    values["fields"][1]["datatype"] = 9
    with pytest.raises(CloudError, match="Field 'y' has the unknown datatype 9"):
        Cloud(decoded(values)).positions()


@pytest.mark.parametrize("row_step", [0, 5])
def test_an_invalid_row_step_is_read_as_dense_with_a_remark(row_step: int) -> None:
    points = [{"x": [i], "y": [0], "z": [0]} for i in range(4)]
    read = Cloud(decoded(cloud(XYZ, points, height=2, row_step=row_step)))
    assert read.positions()[0][:, 0].tolist() == [0, 1, 2, 3]
    assert f"row_step is {row_step}, less than width x point_step, 24" in read.remark


@pytest.mark.parametrize("row_step", [48, 36, 2**32 - 1])
def test_rows_without_gaps_are_drawn_with_any_row_step(row_step: int) -> None:
    points = [{"x": [i], "y": [0], "z": [0]} for i in range(4)]
    read = Cloud(decoded(cloud(XYZ, points, height=2) | {"row_step": row_step}))
    assert read.positions()[0][:, 0].tolist() == [0, 1, 2, 3]
    assert read.remark.startswith(
        f"row_step is {row_step}, although the data fits width x point_step, 24;"
    )


def test_bytes_after_the_points_are_ignored_with_a_remark() -> None:
    values = xyz_cloud([(1, 2, 3)])
    read = Cloud(decoded(values | {"data": np.append(values["data"], np.zeros(2, np.uint8))}))
    assert read.positions()[0].tolist() == [[1, 2, 3]]
    assert "The data has 14 bytes, 12 were enough" in read.remark


def test_a_count_of_0_is_taken_as_1() -> None:
    values = xyz_cloud([(1, 2, 3)])
    for field in values["fields"]:
        field["count"] = 0
    assert Cloud(decoded(values)).positions()[0].tolist() == [[1, 2, 3]]


@pytest.mark.parametrize("is_bigendian", [False, True])
@pytest.mark.parametrize("kind", [FLOAT32, 6, 5])
def test_packed_colours_are_aarrggbb_in_every_type_and_order(kind: int, is_bigendian: bool) -> None:
    order = ">" if is_bigendian else "<"
    (value,) = struct.unpack(order + CODES[kind], struct.pack(order + "I", 0x01020304))
    fields = [*XYZ, ("rgba", 12, kind, 1)]
    points = [{"x": [0], "y": [0], "z": [0], "rgba": [value]}] * 2
    read = Cloud(decoded(cloud(fields, points, is_bigendian=is_bigendian)))
    colors, opacities = packed_colors(read, None)
    assert colors.tolist() == [[2, 3, 4]] * 2
    assert opacities is not None
    assert opacities.tolist() == [1, 1]
