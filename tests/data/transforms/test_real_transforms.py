"""Real /tf of two robots, replayed: against scipy, and the robot's scans against its map."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore
from scipy import ndimage, optimize
from scipy.spatial.transform import Rotation, Slerp
from turtlebot import BAG, DATA, MAP, ORIGIN, RESOLUTION

from webviz.data.transforms import TransformBuffer, diagnose, tree_text

NAV2 = DATA / "bags" / "nav2_turtlebot.mcap"
S = 1_000_000_000

needs_data = pytest.mark.skipif(not DATA.exists(), reason=f"needs recorded data in {DATA}")


def messages(bag: Path, *topics: str) -> Iterator[tuple[str, Any]]:
    with AnyReader([bag], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
        connections = [c for c in reader.connections if c.topic in topics]
        for connection, _, raw in reader.messages(connections):
            yield connection.topic, reader.deserialize(raw, connection.msgtype)


def stamp_of(header: Any) -> int:
    return header.stamp.sec * S + header.stamp.nanosec


def replayed(bag: Path) -> tuple[TransformBuffer, list[tuple[str, str, int, Any, bool]]]:
    """A buffer that keeps all of a bag's transforms, and those as they were sent."""
    buffer = TransformBuffer(cache_time_ns=1000 * S)
    rows = []
    for topic, message in messages(bag, "/tf", "/tf_static"):
        for t in message.transforms:
            p, q = t.transform.translation, t.transform.rotation
            pose = (p.x, p.y, p.z, q.x, q.y, q.z, q.w)
            row = (t.header.frame_id, t.child_frame_id, stamp_of(t.header), pose)
            assert buffer.set_transform(*row[:3], pose[:3], pose[3:], topic == "/tf_static")
            rows.append((*row, topic == "/tf_static"))
    return buffer, rows


def by_scipy(
    rows: list[tuple[str, str, int, Any, bool]], chain: list[str], times: np.ndarray
) -> np.ndarray:
    """Matrices (N, 4, 4) of the last frame of a chain in the first, link by link."""
    out = np.broadcast_to(np.eye(4), (len(times), 4, 4))
    for child in chain[1:]:
        samples = {s[2]: np.array(s[3]) for s in rows if s[1] == child}
        is_static = any(s[4] for s in rows if s[1] == child)
        stamps = np.array(sorted(samples))
        poses = np.array([samples[stamp] for stamp in stamps])
        link = np.tile(np.eye(4), (len(times), 1, 1))
        if is_static:
            link[:, :3, :3] = Rotation.from_quat(poses[-1, 3:]).as_matrix()
            link[:, :3, 3] = poses[-1, :3]
        else:
            seconds, times_s = (stamps - stamps[0]) / S, (times - stamps[0]) / S
            slerp = Slerp(seconds, Rotation.from_quat(poses[:, 3:]))
            link[:, :3, :3] = slerp(times_s).as_matrix()
            for axis in range(3):
                link[:, axis, 3] = np.interp(times_s, seconds, poses[:, axis])
        out = out @ link
    return out


@needs_data
@pytest.mark.parametrize(
    ("bag", "chain"),
    [
        (BAG, ["odom", "base_link", "rplidar_link"]),
        (BAG, ["odom", "base_footprint"]),
        (NAV2, ["map", "odom", "base_link", "left_wheel"]),
        (NAV2, ["map", "odom", "base_link", "shell_link", "rplidar_link"]),
    ],
    ids=lambda value: value[-1] if isinstance(value, list) else value.stem,
)
def test_every_lookup_in_a_recorded_tree_agrees_with_scipy(bag: Path, chain: list[str]) -> None:
    buffer, rows = replayed(bag)
    moving = [child for child in chain[1:] if not any(s[4] for s in rows if s[1] == child)]
    spans = [[s[2] for s in rows if s[1] == child] for child in moving]
    first, last = max(min(span) for span in spans), min(max(span) for span in spans)
    times = np.random.default_rng(1).integers(first, last, 2000, endpoint=True)
    times[:2] = first, last
    expected = by_scipy(rows, chain, times)
    translations, rotations, ok = buffer.lookup_many(chain[0], chain[-1], times)
    assert ok.all()
    np.testing.assert_allclose(translations, expected[:, :3, 3], rtol=0, atol=1e-9)
    np.testing.assert_allclose(
        Rotation.from_quat(rotations).as_matrix(), expected[:, :3, :3], rtol=0, atol=1e-9
    )
    for i, stamp in enumerate(times.tolist()):
        one = buffer.lookup(chain[0], chain[-1], stamp)
        assert one.translation == pytest.approx(expected[i, :3, 3], abs=1e-9)
        assert one.rotation == pytest.approx(rotations[i], abs=1e-9)


@needs_data
def test_all_frames_of_a_recorded_tree_have_a_pose_as_one_at_a_time() -> None:
    buffer, _ = replayed(NAV2)
    poses = buffer.poses_in("map")
    assert poses.ok.all()
    for i, frame in enumerate(poses.frames):
        one = buffer.lookup("map", frame, 0)
        assert poses.stamps_ns[i] == one.stamp_ns
        assert poses.translations[i] == pytest.approx(one.translation, abs=1e-9)
        assert poses.rotations[i] == pytest.approx(one.rotation, abs=1e-9)


@needs_data
def test_a_recorded_tree_is_diagnosed_as_sound() -> None:
    buffer, _ = replayed(NAV2)
    diagnosis = diagnose(buffer)
    assert diagnosis.roots == ("map",)
    assert diagnosis.problems == []
    rates = {report.frame: report.rate_hz for report in diagnosis.frames}
    assert 20 < rates["base_link"] < 40
    assert buffer.rigid_root("rplidar_link") == "base_link"
    assert tree_text(buffer).startswith("map\n└─ odom  [")


@needs_data
def test_the_scans_of_a_recorded_drive_land_on_the_walls_of_its_map() -> None:
    """The bag has no localisation, so one rigid alignment of map and odom stands in for it.

    It is fitted to scans of the first 8 s alone. That the other 38 s of a 7 m drive land on walls
    too is the transforms' doing; what is missing from 100 % is furniture, people and the drift of
    the odometry.
    """
    buffer, _ = replayed(BAG)
    rows = np.frombuffer(MAP.read_bytes()[-903 * 1706 :], np.uint8).reshape(1706, 903)[::-1]
    to_wall = np.asarray(ndimage.distance_transform_edt(rows > 0.35 * 255)) * RESOLUTION

    def distance(points: np.ndarray) -> np.ndarray:
        cells = (points - ORIGIN) / RESOLUTION
        return ndimage.map_coordinates(to_wall, cells[:, ::-1].T, order=1, cval=5.0)

    def aligned(alignment: np.ndarray, points: np.ndarray) -> np.ndarray:
        c, s = np.cos(alignment[2]), np.sin(alignment[2])
        return points @ np.array([[c, s], [-s, c]]) + alignment[:2]

    scans = [scan for _, scan in messages(BAG, "/scan")]
    stamps = np.array([stamp_of(scan.header) for scan in scans])
    translations, rotations, ok = buffer.lookup_many("odom", "rplidar_link", stamps)
    assert ok.sum() >= len(scans) - 1  # the first scan was made before the first transform
    in_laser, in_odom = [], []
    for i in np.flatnonzero(ok):
        ranges = np.asarray(scans[i].ranges)
        hit = np.flatnonzero(np.isfinite(ranges))
        angles = scans[i].angle_min + hit * scans[i].angle_increment
        flat = np.stack((np.cos(angles), np.sin(angles), np.zeros(len(hit))), axis=1)
        points = flat * ranges[hit, None]
        in_laser.append(points[:, :2])
        in_odom.append((Rotation.from_quat(rotations[i]).apply(points) + translations[i])[:, :2])

    start = np.concatenate([points[::6] for points in in_odom[:60:10]])
    fit = optimize.least_squares(
        lambda guess: np.minimum(distance(aligned(guess, start)), 0.5),
        np.zeros(3),
        loss="soft_l1",
        f_scale=0.05,
        x_scale=(0.1, 0.1, 0.02),
    )
    alignment = np.asarray(fit.x)
    assert np.abs(alignment).max() < 0.5  # the drive began where the map did
    on_wall = [float((distance(aligned(alignment, points)) < 0.15).mean()) for points in in_odom]
    assert np.mean(on_wall[:60]) > 0.88
    assert np.mean(on_wall[60:]) > 0.80
    assert min(on_wall) > 0.4
    unplaced = [float((distance(points) < 0.15).mean()) for points in in_laser]
    assert np.mean(unplaced) < 0.1
