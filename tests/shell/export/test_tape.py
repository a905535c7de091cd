"""The tape of an exported run: its chunks, and what each part may take of the file."""

from __future__ import annotations

import msgspec
import pytest

from webviz.scene.adapter.tape import SceneChange
from webviz.shell.export import tape as tapes
from webviz.shell.export.limit import MAX_SKIP, RESERVE, SizeLimit
from webviz.shell.export.tape import KEYFRAME_S, ExportFrame, ExportWriter


def recorded(*frames: tuple[float, dict[str, str]]) -> ExportWriter:
    """A tape of frames: their times, and what changes of a store."""
    tape = ExportWriter(len, SizeLimit(10**9, 100.0), 0)
    for at_s, changes in frames:
        stores = {
            ("some", key): msgspec.Raw(msgspec.json.encode(value)) for key, value in changes.items()
        }
        tape.add(ExportFrame(at_s, at_s, SceneChange((), ()), stores, {}))
    tape.finish()
    return tape


def test_a_value_that_comes_again_is_kept_once(monkeypatch: pytest.MonkeyPatch) -> None:
    frames = (0.0, {"a": "x", "b": "y"}), (KEYFRAME_S, {"c": "x", "b": "y"}), (2 * KEYFRAME_S, {})
    assert [chunk.value for chunk in recorded(*frames).index] == [0, 2, 2]
    monkeypatch.setattr(tapes, "MAX_KNOWN", 1)
    assert [chunk.value for chunk in recorded(*frames).index] == [0, 2, 4]


def test_a_chunk_ends_by_time_or_size() -> None:
    short = recorded((0.0, {"a": "x"}), (1.0, {"a": "y" * 100_000}), (4.9, {}), (5.0, {}))
    assert [chunk.times for chunk in short.index] == [[0.0, 1.0, 4.9], [5.0]]
    large = recorded((0.0, {"a": "x" * (tapes.CHUNK_BYTES + 1)}), (1.0, {"b": "y"}), (2.0, {}))
    assert [chunk.times for chunk in large.index] == [[0.0], [1.0, 2.0]]


def test_the_room_of_a_file_is_shared_by_time() -> None:
    limit = SizeLimit(RESERVE + 8_000_000, 10.0)
    assert limit.room(0, 0.0, 5.0) == 3_000_000, "base64 takes a quarter"
    assert limit.room(4_000_000, 5.0, 10.0) == 3_000_000
    assert limit.room(4_000_000, 5.0, 5.0) == 3_000_000 / 50, "a tenth of a second at least"
    assert limit.room(7_000_000, 10.0, 10.0) == 750_000
    assert limit.room(9_000_000, 5.0, 10.0) == 0


def test_versions_are_left_out_until_a_file_has_room_again() -> None:
    limit = SizeLimit(10**6, 10.0)
    assert limit.notes() == []
    skips = []
    for second, size in enumerate([2, *[2] * 7, *[0] * 7]):
        limit.adapt(size, 1.0, second, second + 1)
        skips.append(limit.skip)
    assert skips == [2, 4, 8, 16, 32, MAX_SKIP, MAX_SKIP, MAX_SKIP, 32, 16, 8, 4, 2, 1, 1]
    assert not limit.is_exceeded
    when = "between 1.0 and 14.0 s"
    assert limit.notes() == [
        f"Of clouds, maps and pictures, at least one of {MAX_SKIP} versions is shown {when}.",
        f"Values of selected points are missing {when}.",
    ]


def test_notes_give_the_least_thinning() -> None:
    limit = SizeLimit(10**6, 10.0, every=4, skip=2)
    assert limit.is_exceeded
    limit.adapt(0, 1.0, 0.0, 5.0)
    limit.adapt(0, 1.0, 5.0, 10.0)
    assert (limit.every, limit.skip) == (2, 1)
    assert limit.notes() == [
        "Clouds keep at least one of 4 points between 0.0 and 10.0 s.",
        "Of clouds, maps and pictures, at least one of 2 versions is shown between 0.0 and 10.0 s.",
        "Values of selected points are missing between 0.0 and 10.0 s.",
    ]
