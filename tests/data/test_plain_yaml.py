"""The one reader of YAML: what it bounds, for every text of others that is YAML."""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest

from webviz.api.errors import Error
from webviz.data.map_file import MapFileError, read_map
from webviz.data.plain_yaml import YamlDocumentError, YamlLimits, read_plain
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.data.recordings.metadata import read_metadata, recorded_counts
from webviz.data.recordings.recording import RecordedChannel, RecordingError
from webviz.panels.yaml_text import read_yaml
from webviz.sources.bag.qos import profiles_of

BOMB = "\n".join(
    [
        f"x0: &l0 {{a: {'x' * 100}}}",
        *(f"x{i}: &l{i} [{', '.join([f'*l{i - 1}'] * 10)}]" for i in range(1, 7)),
    ]
)
"""Document of a million values; more would take the memory of the machine where a test fails."""
SECONDS = 5.0


@pytest.mark.parametrize(
    "text",
    [
        f"{BOMB}\na: *l6",
        "a: &a [*a]",
        "a: &a {b: *a}",
        "\n".join(
            f"x{i}: &l{i} {{<<: [{', '.join([f'*l{i - 1}'] * 9)}]}}" for i in range(1, 9)
        ).replace("[*l0, *l0, *l0, *l0, *l0, *l0, *l0, *l0, *l0]", "{a: 1}"),
        "[" * 5000,
        "- " * 5000 + "a",
        "- a\n" * 60_000,
        "x" * (5 << 20),
        "9" * 5000,
        "0x" + "f" * 5000,
        "!!python/object/apply:os.system [echo]",
        "!!binary aGk=",
        "!!set {a, b}",
        "!other 3",
        "{a: 1, a: 2}",
        "{? [a] : b}",
        "a: 1\n---\nb: 2",
        "[",
    ],
)
def test_endless_and_tagged_yaml_is_refused_quickly(text: str) -> None:
    start_s = time.process_time()
    with pytest.raises(YamlDocumentError) as error:
        read_plain(text)
    assert time.process_time() - start_s < SECONDS
    assert re.fullmatch(r"the text(:\d+)?( |: )[^\n]{10,150}\.", error.value.sentence("the text"))


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("", None),
        ("a: &x [1, 2.5, true, ~, b]\nc: *x", {"a": (a := [1, 2.5, True, None, "b"]), "c": a}),
        ("{b: {<<: &x {a: 1}, c: 2}, d: *x}", {"b": {"a": 1, "c": 2}, "d": {"a": 1}}),
        ("[&x 1, &x 2, *x]", [1, 2, 2]),
        ("day: 2001-02-03", {"day": "2001-02-03"}),
        ("day: 2001-13-45", {"day": "2001-13-45"}),
    ],
)
def test_plain_values_are_read_with_their_aliases(text: str, values: object) -> None:
    assert read_plain(text) == values


def test_limits_count_aliases_each_time() -> None:
    text = "a: &a [1, 2, 3]\nb: [*a, *a]"
    assert read_plain(text, YamlLimits(values=16))["b"] == [[1, 2, 3]] * 2
    for limits in (YamlLimits(values=15), YamlLimits(characters=10), YamlLimits(depth=3)):
        with pytest.raises(YamlDocumentError):
            read_plain(text, limits)
    with pytest.raises(YamlDocumentError, match="Aliases"):
        read_plain(text, YamlLimits(has_aliases=False))


def test_the_qos_of_a_bag_that_unfolds_is_unknown() -> None:
    bomb = "".join(f"- {line}\n" for line in BOMB.splitlines())
    for key in ("reliability", "durability", "depth"):
        assert profiles_of(f"{bomb}- {{{key}: *l6}}") == ()
    assert profiles_of("- {reliability: [2], depth: 3}") == (("reliable", "volatile", 3),)
    assert profiles_of(f"- {{depth: {'9' * 900}}}") == (("reliable", "volatile", 1 << 31),)


def test_metadata_that_unfold_are_damaged(tmp_path: Path) -> None:
    inner = "rosbag2_bagfile_information: {relative_file_paths: [bag_0.mcap], "
    (tmp_path / "metadata.yaml").write_text(f"{BOMB}\n{inner}compression_mode: *l6}}")
    with pytest.raises(RecordingError, match="is damaged: run"):
        read_metadata(tmp_path)
    assert recorded_counts(tmp_path / "bag_0.mcap") == {}
    long = f"{inner}compression_mode: message, compression_format: {'x' * 100_000}}}"
    (tmp_path / "metadata.yaml").write_text(long)
    with pytest.raises(RecordingError) as error:
        read_metadata(tmp_path)
    assert len(str(error.value)) < 400


def test_a_map_that_unfolds_is_refused_by_a_short_sentence(tmp_path: Path) -> None:
    path = tmp_path / "a.map"
    for value in ("*l6", "[*l0]", "x" * 10_000, "x" * 100_000):
        for key in ("resolution", "origin", "mode", "image"):
            head = BOMB if value == "*l6" else "x0: &l0 [1, 2, 3, 4, 5, 6, 7, 8, 9, a, b, c, d, e]"
            good = {"resolution": "1", "origin": "[0, 0, 0]", "image": "a", "mode": "raw"}
            rest = "".join(f"\n{other}: {v}" for other, v in good.items() if other != key)
            path.write_text(f"{head}\n{key}: {value}{rest}")
            with pytest.raises(MapFileError) as error:
                read_map(path)
            assert len(str(error.value)) < 400


def test_a_text_of_a_panel_that_unfolds_is_refused() -> None:
    for text in (f"{BOMB}\na: *l6", "[" * 500, "a: !!binary aGk="):
        with pytest.raises(Error):
            read_yaml(text)


def test_a_recording_keeps_no_qos_that_unfolds(tmp_path: Path) -> None:
    channel = RecordedChannel("/a", "std_msgs/msg/Empty", "cdr", "", f"{BOMB}\na: *l6")
    with_qos = RecordingFolder(tmp_path / "run", "test")
    with_qos.add(channel, 1, bytes(4), 0)
    with_qos.close()
    assert "offered_qos_profiles: []" in (tmp_path / "run/metadata.yaml").read_text()
