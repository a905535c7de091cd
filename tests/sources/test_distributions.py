"""Bags that other distributions of ROS 2 wrote, with and without definitions of their types."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Callable, Iterator, Sequence
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from filled_messages import filled
from rosbags.interfaces import Nodetype
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from webviz.data.messages import decode, type_exists
from webviz.data.messages.decode import is_whole
from webviz.data.messages.distributions import CHANGED, UndefinedMessages, may_differ
from webviz.data.messages.encode import encode
from webviz.data.recordings import open_recording
from webviz.data.recordings.mcap_writing import McapFile
from webviz.sources.bag.file import BagFile

RELEASED = [
    Stores[f"ROS2_{name}"]
    for name in ("FOXY", "GALACTIC", "HUMBLE", "IRON", "JAZZY", "KILTED", "LYRICAL")
]
REPORTS = Path(__file__).parents[3] / "shared/data/reports/B1"
MARKER = "visualization_msgs/msg/Marker"
MARKERS = "visualization_msgs/msg/MarkerArray"
RANGE = "sensor_msgs/msg/Range"
GID = "rmw_dds_common/msg/Gid"
"""It became an array of another length, and only the middleware itself sends it."""
NESTED = (
    MARKERS,
    "visualization_msgs/msg/InteractiveMarkerUpdate",
    "visualization_msgs/msg/InteractiveMarkerInit",
)
"""Types that contain one that has changed."""


def check_same(store: Any, name: str, expected: Any, read: Any) -> None:
    """Check that a message has the values that were written; those that are missing, defaults."""
    for field, (kind, value) in store.fielddefs[name][1]:
        if hasattr(read, field):
            _check_value(store, kind, value, getattr(expected, field), getattr(read, field))


def _check_value(store: Any, kind: Nodetype, value: Any, expected: Any, read: Any) -> None:
    if kind == Nodetype.NAME:
        check_same(store, value, expected, read)
    elif kind == Nodetype.BASE or isinstance(expected, np.ndarray):
        np.testing.assert_array_equal(np.asarray(expected), np.asarray(read))
    else:
        (inner, base), _ = value
        assert len(expected) == len(read)
        if not isinstance(read, np.ndarray):  # points and colours become rows of numbers
            for one, other in zip(expected, read, strict=True):
                _check_value(store, inner, base, one, other)


def write(
    path: Path, store: Any, messages: Sequence[tuple[str, Any]], storage: StoragePlugin
) -> Path:
    """Write a bag by another library, a db3 without definitions, as Humble and older do."""
    with Writer(path, version=8, storage_plugin=storage) as writer:
        connections = {
            name: writer.add_connection(f"/{name.split('/')[-1]}", name, typestore=store)
            for name in dict.fromkeys(name for name, _ in messages)
        }
        for at, (name, message) in enumerate(messages):
            data = store.serialize_cdr(message, name)
            writer.write(connections[name], 1_700_000_000_000_000_000 + at * 10**8, data)
    for file in path.glob("*.db3"):
        with sqlite3.connect(file) as db:
            tables = [name for (name,) in db.execute("SELECT name FROM sqlite_master")]
            if "message_definitions" in tables:
                db.execute("DELETE FROM message_definitions")
        db.close()
    return path


@pytest.fixture
def open_bag() -> Iterator[Callable[[Path], BagFile]]:
    """Open bags, and close them after the test."""
    files: list[BagFile] = []

    def open_one(path: Path) -> BagFile:
        files.append(BagFile(path))
        return files[-1]

    yield open_one
    for file in files:
        file.close()


def messages_of(file: BagFile) -> dict[str, list[Any]]:
    """Return the messages of a bag by type."""
    result: dict[str, list[Any]] = {}
    for each in file.messages(file.channels, file.start_ns):
        result.setdefault(each.type, []).append(decode(each.type, each.cdr, each.types))
    return result


def test_the_types_that_changed_are_those_of_the_released_distributions() -> None:
    changed = set()
    here = get_typestore(Stores.ROS2_JAZZY).fielddefs
    for each in RELEASED:
        there = get_typestore(each).fielddefs
        changed |= {name for name in there if name in here and there[name][1] != here[name][1]}
    assert changed == CHANGED


@pytest.mark.parametrize("storage", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
@pytest.mark.parametrize("distribution", RELEASED, ids=lambda store: store.name)
def test_messages_of_each_distribution_have_the_values_that_were_written(
    tmp_path: Path,
    open_bag: Callable[[Path], BagFile],
    distribution: Stores,
    storage: StoragePlugin,
) -> None:
    store, numbers = get_typestore(distribution), count(1)
    names = [name for name in (*sorted(CHANGED - {GID}), *NESTED) if name in store.fielddefs]
    messages = [(name, filled(store, name, numbers)) for name in names for _ in range(2)]
    file = open_bag(write(tmp_path / "run", store, messages, storage))
    result = messages_of(file)
    assert not file.skipped
    assert not file.warnings
    for name in names:
        expected = [message for own, message in messages if own == name]
        assert len(result[name]) == len(expected)
        for one, other in zip(expected, result[name], strict=True):
            check_same(store, name, one, other)


def test_fields_missing_in_an_older_distribution_have_defaults(
    tmp_path: Path, open_bag: Callable[[Path], BagFile]
) -> None:
    store = get_typestore(Stores.ROS2_GALACTIC)
    names = (RANGE, MARKER)
    messages = [(name, filled(store, name, count(1))) for name in names]
    result = messages_of(open_bag(write(tmp_path / "run", store, messages, StoragePlugin.SQLITE3)))
    assert result[RANGE][0].variance == 0.0
    (marker,) = result[MARKER]
    assert (marker.texture_resource, len(marker.uv_coordinates)) == ("", 0)
    assert marker.mesh_file.filename == ""


def test_empty_messages_do_not_decide_which_distribution_wrote_a_bag() -> None:
    store = get_typestore(Stores.ROS2_GALACTIC)
    kind = store.types
    markers = UndefinedMessages(MARKERS)
    empty = bytes(store.serialize_cdr(kind[MARKERS](markers=[]), MARKERS))
    marker = filled(store, MARKER, count(1))
    several = bytes(store.serialize_cdr(kind[MARKERS](markers=[marker, marker]), MARKERS))
    assert len(decode(MARKERS, markers.to_cdr(empty)).markers) == 0
    assert [each.id for each in decode(MARKERS, markers.to_cdr(several)).markers] == [marker.id] * 2
    assert len(decode(MARKERS, markers.to_cdr(empty)).markers) == 0


def test_a_message_that_no_distribution_wrote_stays_as_it_is() -> None:
    cut = encode(RANGE, {"field_of_view": 1.0})[:-9]
    assert UndefinedMessages(RANGE).to_cdr(cut) == cut


def test_types_of_newer_distributions_are_read_from_bags_without_definitions(
    tmp_path: Path, open_bag: Callable[[Path], BagFile]
) -> None:
    store, name = get_typestore(Stores.ROS2_LYRICAL), "nav_msgs/msg/Trajectory"
    assert not type_exists(name)
    expected = filled(store, name, count(1))
    file = open_bag(write(tmp_path / "run", store, [(name, expected)], StoragePlugin.SQLITE3))
    assert not file.skipped
    (message,) = messages_of(file)[name]
    check_same(store, name, expected, message)


@pytest.mark.parametrize("distribution", [Stores.ROS2_GALACTIC, Stores.ROS2_HUMBLE])
def test_a_copy_of_their_messages_has_the_definitions_that_fit(
    tmp_path: Path, open_bag: Callable[[Path], BagFile], distribution: Stores
) -> None:
    store = get_typestore(distribution)
    names = (RANGE, MARKER)
    messages = [(name, filled(store, name, count(1))) for name in names]
    file = open_bag(write(tmp_path / "run", store, messages, StoragePlugin.SQLITE3))
    copy = tmp_path / "copy.mcap"
    with contextlib.closing(McapFile(copy, "test")) as mcap:
        for channel in file.channels:
            for each in file.messages([channel], file.start_ns):
                mcap.add(channel.written, each.stamp_ns, each.cdr)
    recording = open_recording(copy)
    assert all("MSG:" in channel.definition for channel in recording.channels)
    recording.close()
    assert {key: len(each) for key, each in messages_of(open_bag(copy)).items()} == dict.fromkeys(
        names, 1
    )


def test_fields_of_a_newer_definition_are_left_out(
    tmp_path: Path, open_bag: Callable[[Path], BagFile]
) -> None:
    store = get_typestore(Stores.ROS2_JAZZY)
    constants, fields = store.fielddefs.pop(MARKER)
    newer = [*fields, ("smell", (Nodetype.BASE, ("string", 0)))]
    store.register({MARKER: (constants, newer)})
    expected = filled(store, MARKER, count(1))
    file = open_bag(write(tmp_path / "run", store, [(MARKER, expected)], StoragePlugin.MCAP))
    (marker,) = messages_of(file)[MARKER]
    assert (marker.id, marker.text) == (expected.id, expected.text)


def test_a_message_that_is_followed_by_more_than_padding_is_not_whole() -> None:
    cdr = encode(RANGE, {"range": 1.0})
    assert is_whole(RANGE, cdr + bytes(3))
    assert not is_whole(RANGE, cdr + bytes(4))


def test_a_definition_with_other_fields_of_the_same_names_is_refused(
    tmp_path: Path, open_bag: Callable[[Path], BagFile]
) -> None:
    store = get_typestore(Stores.ROS2_GALACTIC)
    path = write(
        tmp_path / "run", store, [(MARKER, filled(store, MARKER, count(1)))], StoragePlugin.MCAP
    )
    (file,) = path.glob("*.mcap")
    file.write_bytes(file.read_bytes().replace(b"int32 id\n", b"int16 id\n"))
    assert "visualization_msgs/msg/Marker differs" in open_bag(file).skipped["/Marker"]


def test_a_definition_that_is_another_type_is_refused_with_its_name(
    tmp_path: Path, open_bag: Callable[[Path], BagFile]
) -> None:
    store = get_typestore(Stores.ROS2_GALACTIC)
    name = MARKER
    path = write(
        tmp_path / "run", store, [(name, filled(store, name, count(1)))], StoragePlugin.MCAP
    )
    (file,) = path.glob("*.mcap")
    file.write_bytes(file.read_bytes().replace(b"string ns\n", b"float32 n\n"))
    bag = open_bag(file)
    assert not bag.channels
    assert "visualization_msgs/msg/Marker differs" in bag.skipped["/Marker"]


def test_types_that_contain_a_changed_one_may_differ() -> None:
    assert all(map(may_differ, NESTED))
    assert not may_differ("sensor_msgs/msg/LaserScan")


@pytest.mark.skipif(not REPORTS.is_dir(), reason="needs ../shared/data/reports/B1")
@pytest.mark.parametrize("storage", ["db3", "mcap"])
def test_bags_of_galactic_and_humble_are_decoded(
    open_bag: Callable[[Path], BagFile], storage: str
) -> None:
    result = messages_of(open_bag(REPORTS / f"galactic_marker_{storage}"))
    assert {(each.type, each.pose.position.x) for each in result[MARKER]} == {(1, 2.0)}
    array = result[MARKERS][0].markers
    assert [each.pose.position.x for each in array] == [2.0, 4.0]
    distances = messages_of(open_bag(REPORTS / f"humble_range_{storage}"))[RANGE]
    assert {each.range for each in distances} == {2.0}
