"""The transforms of a message in one pass leave what they leave one by one."""

import math
import random

import numpy as np
import pytest

from webviz.data.transforms import TransformBuffer
from webviz.data.transforms.cache import TimeCache
from webviz.data.transforms.geometry import PACKED

S = 1_000_000_000
Row = tuple[str, str, int, list[float]]


def one_by_one(buffer: TransformBuffer, rows: list[Row], authority: str, received_ns: int) -> None:
    for parent, child, stamp_ns, (x, y, z, qx, qy, qz, qw) in rows:
        buffer.set_transform(
            parent, child, stamp_ns, (x, y, z), (qx, qy, qz, qw), False, authority, received_ns
        )


def at_once(buffer: TransformBuffer, rows: list[Row], authority: str, received_ns: int) -> None:
    names = [(parent, child) for parent, child, _, _ in rows]
    poses = np.array([pose for _, _, _, pose in rows])
    buffer.set_moving(names, [stamp for _, _, stamp, _ in rows], poses, authority, received_ns)


def message(dice: random.Random, tick: int) -> list[Row]:
    """Mostly what the tick before had, later; here and there something that is new or wrong."""
    rows = []
    for i in range(8):
        parent, child, stamp = f"f{i // 2}", f"f{i + 1}", S + tick * S // 10
        pose = [dice.uniform(-9.0, 9.0) for _ in range(7)]
        match dice.randrange(40):
            case 0:
                parent = "elsewhere"
            case 1:
                stamp -= dice.choice([S // 20, S // 10, 20 * S])
            case 2:
                pose[dice.randrange(7)] = dice.choice([math.nan, math.inf])
            case 3:
                pose[3:] = [0.0] * 4
            case 4:
                child = f"/{child}"
            case 5:
                pose[3:] = dice.choice([[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.5, 0.5]])
        rows.append((parent, child, stamp, pose))
    return rows


@pytest.mark.parametrize("seed", range(20))
def test_all_at_once_is_as_one_by_one(seed: int) -> None:
    dice = random.Random(seed)
    expected, found = TransformBuffer(2 * S), TransformBuffer(2 * S)
    refused = False
    for tick in range(60):
        rows = message(dice, tick)
        authority, received_ns = dice.choice(["a", "a", "a", "b"]), (tick + 2) * S // 10
        if dice.randrange(20) == 0:
            expected.clear()
            found.clear()
        one_by_one(expected, rows, authority, received_ns)
        at_once(found, rows, authority, received_ns)
        assert found.refusals.rejections == expected.refusals.rejections
        refused = refused or bool(found.refusals.rejections)
    assert found.frames() == expected.frames()
    assert found.version == expected.version
    assert found.structure_version == expected.structure_version
    assert refused
    for child, cache in expected.tree.caches.items():
        other = found.tree.caches[child]
        assert isinstance(cache, TimeCache)
        assert isinstance(other, TimeCache)
        assert other.stamps == cache.stamps
        assert other.parents == cache.parents
        for pose, other_pose in zip(cache.poses, other.poses, strict=True):
            assert PACKED.unpack(other_pose) == pytest.approx(PACKED.unpack(pose), abs=1e-12)
        whose, others = expected.publishers[child], found.publishers[child]
        assert (others.current, others.claim) == (whose.current, whose.claim)
        assert (others.contest, others.delay_ns) == (whose.contest, whose.delay_ns)
