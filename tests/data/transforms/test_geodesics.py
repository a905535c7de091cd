"""Properties that any transform must have, on random trees and poses."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from webviz.data.transforms import Transform, TransformBuffer
from webviz.data.transforms.arrays import (
    canonical_many,
    compose_many,
    inverse_many,
    to_pairs,
    to_rows,
)
from webviz.data.transforms.geometry import canonical, compose, inverse

S = 1_000_000_000
coordinate = st.floats(-1000.0, 1000.0)
Pose = tuple[float, float, float, float, float, float, float]


@st.composite
def rotations(draw: st.DrawFn) -> tuple[float, float, float, float]:
    values = draw(st.tuples(*[st.floats(-1.0, 1.0)] * 4))
    length = math.sqrt(sum(v * v for v in values))
    assume(length > 1e-3)
    x, y, z, w = (v / length for v in values)
    return x, y, z, w


@st.composite
def poses(draw: st.DrawFn) -> Pose:
    x, y, z = draw(st.tuples(coordinate, coordinate, coordinate))
    return (x, y, z, *draw(rotations()))


def matrix(transform: Transform) -> np.ndarray:
    out = np.eye(4)
    out[:3, :3] = Rotation.from_quat(transform.rotation).as_matrix()
    out[:3, 3] = transform.translation
    return out


def chain_of(links: list[Pose]) -> TransformBuffer:
    buffer = TransformBuffer()
    for i, pose in enumerate(links):
        buffer.set_transform(f"f{i}", f"f{i + 1}", S, pose[:3], pose[3:])
    return buffer


@given(poses(), poses())
def test_a_lookup_from_time_to_time_joins_both_poses(before: Pose, after: Pose) -> None:
    buffer = TransformBuffer()
    for stamp_ns, pose in ((S, before), (2 * S, after)):
        buffer.set_transform("map", "base", stamp_ns, pose[:3], pose[3:])
    body_motion = buffer.lookup_full("base", 2 * S, "base", S, "map")
    then, now = buffer.lookup("map", "base", S), buffer.lookup("map", "base", 2 * S)
    assert matrix(now) @ matrix(body_motion) == pytest.approx(matrix(then), abs=1e-8)


@given(st.lists(poses(), min_size=1, max_size=6))
def test_there_and_back_is_the_identity(links: list[Pose]) -> None:
    buffer = chain_of(links)
    last = f"f{len(links)}"
    there, back = buffer.lookup("f0", last, S), buffer.lookup(last, "f0", S)
    assert matrix(there) @ matrix(back) == pytest.approx(np.eye(4), abs=1e-8)


@given(st.lists(poses(), min_size=2, max_size=6), st.data())
def test_a_detour_over_any_frame_of_the_chain_changes_nothing(
    links: list[Pose], data: st.DataObject
) -> None:
    buffer = chain_of(links)
    a, b, c = (data.draw(st.integers(0, len(links))) for _ in range(3))
    direct = buffer.lookup(f"f{a}", f"f{c}", S)
    detour = matrix(buffer.lookup(f"f{a}", f"f{b}", S)) @ matrix(buffer.lookup(f"f{b}", f"f{c}", S))
    assert matrix(direct) == pytest.approx(detour, abs=1e-8)


@given(st.lists(poses(), min_size=1, max_size=6))
def test_a_chain_is_the_product_of_its_links_in_order(links: list[Pose]) -> None:
    product = np.eye(4)
    for pose in links:
        product = product @ matrix(Transform(pose[:3], pose[3:], 0))
    transform = chain_of(links).lookup("f0", f"f{len(links)}", S)
    assert matrix(transform) == pytest.approx(product, abs=1e-8)


@given(poses(), poses(), st.integers(0, S))
def test_interpolation_stays_on_the_geodesic_at_constant_speed(
    start: Pose, end: Pose, offset: int
) -> None:
    buffer = TransformBuffer()
    buffer.set_transform("a", "b", S, start[:3], start[3:])
    buffer.set_transform("a", "b", 2 * S, end[:3], end[3:])
    transform = buffer.lookup("a", "b", S + offset)
    ratio = offset / S
    straight = [(1 - ratio) * u + ratio * v for u, v in zip(start[:3], end[:3], strict=True)]
    assert transform.translation == pytest.approx(straight, abs=1e-9)
    first, last = Rotation.from_quat(start[3:]), Rotation.from_quat(end[3:])
    whole = (first.inv() * last).magnitude()
    assume(whole < math.pi - 1e-3)  # half a turn has two shortest ways
    here = Rotation.from_quat(transform.rotation)
    assert (first.inv() * here).magnitude() == pytest.approx(ratio * whole, abs=1e-7)
    assert (here.inv() * last).magnitude() == pytest.approx((1 - ratio) * whole, abs=1e-7)


@given(rotations())
def test_the_canonical_quaternion_is_the_same_rotation_of_unit_length(
    rotation: tuple[float, float, float, float],
) -> None:
    result = canonical(*rotation)
    assert math.hypot(*result) == pytest.approx(1.0, abs=1e-12)
    assert abs(np.dot(result, rotation)) == pytest.approx(1.0, abs=1e-12)
    trace = 4 * rotation[3] ** 2 - 1
    assume(abs(trace) > 1e-9)
    if trace > 0:
        assert result[3] > 0
    else:
        largest = max(abs(value) for value in result[:3])
        assert any(value > 0 for value in result[:3] if abs(value) > largest - 1e-9)


@given(st.lists(st.tuples(poses(), poses()), min_size=1, max_size=5))
@settings(max_examples=50)
def test_the_array_formulas_agree_with_those_for_one_pose(pairs: list[tuple[Pose, Pose]]) -> None:
    a, b = (np.array([pair[i] for pair in pairs]).T for i in (0, 1))
    joined = np.array([compose(p, q) for p, q in pairs]).T
    assert to_rows(compose_many(to_pairs(a), to_pairs(b))) == pytest.approx(joined, abs=1e-9)
    undone = to_rows(inverse_many(to_pairs(a)))
    assert undone == pytest.approx(np.array([inverse(p) for p, _ in pairs]).T, abs=1e-9)
    signs = np.array([canonical(*p[3:]) for p, _ in pairs]).T
    trace = 4 * a[6] ** 2 - 1
    assume((np.abs(trace) > 1e-9).all())
    assert np.abs((canonical_many(a[3:]) * signs).sum(axis=0)) == pytest.approx(1.0)
