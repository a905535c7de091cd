"""Messages of a bag and the times they are delivered."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Collection, Iterator
from pathlib import Path

import pytest
from bags import START_NS, TF, Bag, files, ns, stamped, strings
from rosbags.rosbag2 import CompressionMode, StoragePlugin

from tests.sources.conftest import PlayedBag
from webviz.data.messages import decode, register
from webviz.sources import Inbox
from webviz.sources.bag.history import BagHistory
from webviz.sources.history import HistoryChannel, Recorded
from webviz.sources.history.playhead import MAX_BATCH

KINDS = [
    (StoragePlugin.SQLITE3, CompressionMode.NONE),
    (StoragePlugin.SQLITE3, CompressionMode.FILE),
    (StoragePlugin.SQLITE3, CompressionMode.MESSAGE),
    (StoragePlugin.MCAP, CompressionMode.NONE),
    (StoragePlugin.MCAP, CompressionMode.FILE),
    (StoragePlugin.MCAP, CompressionMode.MESSAGE),
    (StoragePlugin.MCAP, CompressionMode.STORAGE),
]


@pytest.mark.parametrize(("storage", "compression"), KINDS, ids=lambda kind: kind.name.lower())
def test_messages_arrive_up_to_the_time_played(
    tmp_path: Path,
    open_bag: Callable[..., PlayedBag],
    storage: StoragePlugin,
    compression: CompressionMode,
) -> None:
    bag = open_bag(strings(0, 1, 2.5, 4).write(tmp_path / "bag", storage, compression))
    bag.want("/words")
    assert bag.texts() == []
    bag.play(1)
    assert bag.texts() == ["0", "1"]
    assert bag.source.now_ns() == START_NS + ns(1)
    bag.play(4)
    assert bag.texts() == ["2.5", "4"]
    assert (bag.source.history.start_ns, bag.source.history.end_ns) == (START_NS, START_NS + ns(4))


@pytest.mark.parametrize("compression", [CompressionMode.NONE, CompressionMode.MESSAGE])
@pytest.mark.parametrize(
    ("storage", "ending"), [(StoragePlugin.MCAP, ".mcap"), (StoragePlugin.SQLITE3, ".db3")]
)
def test_a_file_of_a_bag_is_a_bag(
    tmp_path: Path,
    open_bag: Callable[..., PlayedBag],
    storage: StoragePlugin,
    ending: str,
    compression: CompressionMode,
) -> None:
    (file,) = files(strings(0, 1).write(tmp_path / "bag", storage, compression), ending)
    bag = open_bag(file)
    assert bag.words_until(1) == ["0", "1"]
    assert bag.source.warnings == []


def test_compressed_messages_are_unpacked_without_metadata(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    folder = strings(0, 1).write(tmp_path / "bag", compression=CompressionMode.MESSAGE)
    (folder / "metadata.yaml").unlink()
    assert open_bag(folder).words_until(1) == ["0", "1"]


def test_a_damaged_compressed_message_is_skipped(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    (file,) = files(
        strings(0, 1, 2).write(tmp_path / "bag", compression=CompressionMode.MESSAGE), ".mcap"
    )
    data = file.read_bytes()
    places = [match.start() for match in re.finditer(re.escape(b"\x28\xb5\x2f\xfd"), data)]
    assert len(places) == 3
    at = places[1] + 5
    file.write_bytes(data[:at] + b"\xff" * 4 + data[at + 4 :])
    bag = open_bag(file)
    assert bag.words_until(2) == ["0", "2"]
    assert bag.source.warnings == [
        f"{file.name} is damaged: 1 chunk is incomplete (a message in it: its zstd data is "
        "damaged); everything else is shown."
    ]


def test_a_message_arrives_with_the_time_of_its_recording(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    bag = open_bag(strings(0, 1.25).write(tmp_path / "bag"))
    bag.want("/words")
    bag.play(1.25)
    assert [raw.received_ns - START_NS for raw in bag.source.inbox.drain()["/words"]] == [
        0,
        ns(1.25),
    ]


def test_many_messages_come_in_parts_and_none_is_lost(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    seconds = [0.001 * i for i in range(3 * MAX_BATCH)]
    bag = open_bag(strings(*seconds).write(tmp_path / "bag"))
    bag.want("/words")
    source, expected = bag.source, []
    while source.reached_ns < source.history.end_ns:
        source.play_until(source.history.end_ns)
        expected.append(bag.texts())
    assert max(map(len, expected)) <= MAX_BATCH
    assert [float(text) for part in expected for text in part] == pytest.approx(seconds)


def test_large_messages_come_in_parts_too(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.sources.history.playhead.MAX_BATCH_BYTES", 15)  # each has 10
    bag = open_bag(strings(0, 1, 2).write(tmp_path / "bag"))
    bag.want("/words")
    for texts in (["0", "1"], ["2"]):
        bag.source.play_until(bag.source.history.end_ns)
        assert bag.texts() == texts


def test_playing_to_a_time_that_is_over_changes_nothing(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    bag = open_bag(strings(0, 1, 2).write(tmp_path / "bag"))
    bag.want("/words")
    bag.play(1.5)
    bag.source.play_until(bag.source.history.start_ns)
    assert bag.source.reached_ns == START_NS + ns(1.5)


def steps(bag: PlayedBag) -> list[int]:
    """The number of messages of each step in which a bag is played to its end."""
    bag.want("/words")
    counts = []
    while bag.source.reached_ns < bag.source.history.end_ns:
        bag.source.play_step(bag.source.history.end_ns)
        counts.append(len(bag.texts()))
    return counts


def test_a_bag_of_days_is_played_in_as_many_steps_as_it_has_messages(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    day_s = 86_400.0
    bag = open_bag(strings(0, day_s, day_s + 0.01, 3 * day_s, 6.4 * day_s).write(tmp_path / "bag"))
    assert steps(bag) == [1, 1, 1, 1, 1]


def test_a_dense_bag_is_played_in_steps_of_a_tenth_of_a_second(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    bag = open_bag(strings(*[0.01 * number for number in range(80)]).write(tmp_path / "bag"))
    assert steps(bag) == [10] * 8


def test_a_late_subscription_begins_with_the_newest_message(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    bag = open_bag(strings(0, 1, 2).write(tmp_path / "bag"))
    bag.play(1)
    assert bag.words_until(2) == ["1", "2"]


def test_a_second_subscription_loses_no_message_of_the_first(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    recorded = strings(0, 1, 2, 3)
    recorded.add("/more", "std_msgs/msg/String")
    recorded.put(2, "/more", {"data": "more"})
    bag = open_bag(recorded.write(tmp_path / "bag"))
    bag.want("/words")
    bag.play(1)
    bag.want("/words", "/more")
    bag.play(3)
    arrived = bag.source.inbox.drain()
    assert [len(arrived["/words"]), len(arrived["/more"])] == [4, 1]


def test_a_second_subscription_after_a_seek_loses_no_message_of_the_first(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    recorded = strings(0, 1, 2, 3)
    recorded.add("/more", "std_msgs/msg/String")
    bag = open_bag(recorded.write(tmp_path / "bag"))
    bag.want("/words")
    bag.source.jump(START_NS + ns(2))
    bag.want("/words", "/more")
    bag.play(3)
    assert bag.texts() == ["2", "3"]


def test_an_unsubscribed_topic_is_silent(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    bag = open_bag(strings(0, 1).write(tmp_path / "bag"))
    bag.want("/words")
    bag.play(0)  # of which the message waits
    bag.want()
    bag.play(1)
    assert bag.texts() == []


def test_latched_messages_are_repeated_for_late_subscriptions(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    bag = open_bag(strings(0, 1, 2, 9, latched=True, depth=2).write(tmp_path / "bag"))
    bag.play(5)
    bag.want("/words")
    assert bag.texts() == ["1", "2"]
    bag.want("/words", resubscriptions=1)
    assert bag.texts() == ["1", "2"]
    bag.play(9)
    assert bag.texts() == ["9"]


@pytest.mark.parametrize(("max_bytes", "expected"), [(20, ["2", "3"]), (1, ["3"])])
def test_repeated_latched_messages_are_limited_by_the_inbox(
    tmp_path: Path,
    open_bag: Callable[..., PlayedBag],
    monkeypatch: pytest.MonkeyPatch,
    max_bytes: int,
    expected: list[str],
) -> None:
    inbox = functools.partial(Inbox, max_bytes=max_bytes)  # each message has 10
    monkeypatch.setattr("webviz.sources.player.Inbox", inbox)
    bag = open_bag(strings(0, 1, 2, 3, latched=True, depth=3).write(tmp_path / "bag"))
    bag.play(3)
    bag.want("/words")
    bag.texts()
    bag.want("/words", resubscriptions=1)
    assert bag.texts() == expected


def test_all_static_transforms_are_repeated(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    recorded = Bag()
    for at_s, child in enumerate(("a", "b", "c")):
        recorded.transform(at_s, "map", child, static=True)
    bag = open_bag(recorded.write(tmp_path / "bag"))
    bag.play(2)
    bag.want("/tf_static", type_name=TF)
    arrived = bag.source.inbox.drain()["/tf_static"]
    children = [decode(TF, raw.cdr).transforms[0].child for raw in arrived]
    assert children == ["a", "b", "c"]


def test_topics_are_offered_as_they_were_published(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    recorded = strings(0, best_effort=True)
    recorded.add("/map_name", "std_msgs/msg/String", latched=True)
    recorded.put(0, "/map_name", {"data": "lab"})
    bag = open_bag(recorded.write(tmp_path / "run"))
    (words,) = bag.source.offers()["/words"].publishers
    (name,) = bag.source.offers()["/map_name"].publishers
    assert (words.node, words.type) == ("the bag run", "std_msgs/msg/String")
    assert (words.reliability, words.durability) == ("best_effort", "volatile")
    assert (name.reliability, name.durability) == ("reliable", "transient_local")
    assert bag.source.offers()["/words"].requested is None
    bag.want("/words")
    assert bag.source.offers()["/words"].requested == ("best_effort", "volatile")


def test_an_unknown_type_is_learnt_from_the_bag(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    text = "string data\nint32 number\n"
    recorded = strings(0)
    recorded.add("/own", "learnt_msgs/msg/Own", definition=text)
    cdr = b"\x00\x01\x00\x00" + b"\x03\x00\x00\x00hi\x00\x00" + b"\x07\x00\x00\x00"
    recorded.put(0, "/own", cdr)
    bag = open_bag(recorded.write(tmp_path / "bag"))
    bag.want("/own", type_name="learnt_msgs/msg/Own")
    bag.play(1)
    (raw,) = bag.source.inbox.drain()["/own"]
    message = decode("learnt_msgs/msg/Own", raw.cdr, raw.types)
    assert (message.data, message.number) == ("hi", 7)
    assert bag.source.warnings == []


def test_a_type_that_was_known_before_is_read_as_the_bag_defines_it(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    register("aged_msgs/msg/Own", "int8 old\n")
    recorded = Bag()
    recorded.add("/own", "aged_msgs/msg/Own", definition="string data\n")
    recorded.put(0, "/own", b"\x00\x01\x00\x00\x03\x00\x00\x00hi\x00")
    bag = open_bag(recorded.write(tmp_path / "bag"))
    bag.want("/own", type_name="aged_msgs/msg/Own")
    bag.play(1)
    assert bag.texts("/own", "aged_msgs/msg/Own") == ["hi"]


@pytest.mark.parametrize("text", ["", "nonsense of a definition!", "other_msgs/Missing part\n"])
def test_a_subscribed_type_without_a_definition_is_skipped_and_reported(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], text: str
) -> None:
    recorded = strings(0, 1)
    recorded.add("/odd", "odd_msgs/msg/Odd", definition=text)
    recorded.put(0, "/odd", b"\x00\x01\x00\x00")
    bag = open_bag(recorded.write(tmp_path / "bag"))
    assert bag.source.warnings == []
    bag.want("/words", "/odd")
    (warning,) = bag.source.warnings
    assert warning.startswith("/odd is skipped: ")
    assert "odd_msgs/msg/Odd" in warning
    assert bag.source.offers()["/odd"].problem
    bag.play(1)
    assert bag.texts() == ["0", "1"]


@pytest.mark.parametrize("text", ["string request\n---\nstring response\n", "string words\n"])
def test_service_events_are_skipped_without_a_parser_s_words(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], text: str
) -> None:
    recorded = strings(0)
    recorded.add("/ask/_service_event", "odd_msgs/srv/Ask_Event", definition=text)
    recorded.put(0, "/ask/_service_event", b"\x00\x01\x00\x00")
    bag = open_bag(recorded.write(tmp_path / "bag"))
    offer = bag.source.offers()["/ask/_service_event"]
    assert offer.problem == "service events are unsupported"


def test_a_recorded_clock_is_the_time(tmp_path: Path, open_bag: Callable[..., PlayedBag]) -> None:
    recorded = strings(0, 1, 2, 3)
    recorded.add("/clock", "rosgraph_msgs/msg/Clock")
    for at_s in (0.5, 1.5, 2.5):
        recorded.put(at_s, "/clock", {"clock": {"sec": 10 + round(at_s)}})
    bag = open_bag(recorded.write(tmp_path / "bag"))
    assert bag.source.now_ns() == ns(10)  # before anything arrived
    bag.want("/words")
    bag.play(2)
    assert bag.source.now_ns() == ns(12)
    received = [raw.received_ns for raw in bag.source.inbox.drain()["/words"]]
    assert received == [ns(10), ns(10), ns(12)]
    bag.source.jump(bag.source.history.start_ns)
    assert bag.source.now_ns() == ns(10)


@pytest.mark.parametrize("offset_s", [100, START_NS // ns(1) + 2 * 3600])
def test_transforms_of_another_time_set_the_time(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], offset_s: int
) -> None:
    recorded = Bag()
    recorded.add("/tf", TF)
    for at_s in (1, 2):
        recorded.put(at_s, "/tf", {"transforms": [stamped("map", "base", ns(offset_s + at_s))]})
    bag = open_bag(recorded.write(tmp_path / "bag"))
    bag.play(0.5)
    assert bag.source.now_ns() == ns(offset_s) + ns(1.5)
    (warning,) = bag.source.warnings
    assert f"The transforms begin at {offset_s + 1}.0 s" in warning


def test_transforms_that_come_late_do_not_set_the_time(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    recorded = Bag()
    recorded.transform(0, "map", "base")
    recorded.messages = [(600, *message[1:]) for message in recorded.messages]
    bag = open_bag(recorded.write(tmp_path / "bag"))
    assert bag.source.now_ns() == bag.source.reached_ns
    assert bag.source.warnings == []


def test_topics_are_named_and_remapped_as_for_a_node(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    bag = open_bag(strings(0).write(tmp_path / "bag"), remappings={"/scan": "/front/scan"})
    names = ("scan", "/scan", "odom", "~/path")
    resolved = [bag.source.resolve(name) for name in names]
    assert resolved == ["/front/scan", "/front/scan", "/odom", "/webviz/path"]
    for wrong in ("/a b", "", "/1st", "/a//b", "/a/"):
        with pytest.raises(ValueError, match="is not a valid topic name"):
            bag.source.resolve(wrong)


def test_messages_of_one_stamp_arrive_together_however_many_they_are(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    bag = open_bag(strings(*[0.0] * (MAX_BATCH + 5), 1).write(tmp_path / "bag"))
    bag.want("/words")
    bag.source.play_until(bag.source.history.end_ns)
    assert len(bag.texts()) == MAX_BATCH + 5
    assert bag.source.reached_ns == START_NS
    bag.source.play_until(bag.source.history.end_ns)
    assert bag.texts() == ["1"]


def test_latched_messages_of_all_publishers_are_repeated(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    folder = strings(0, 1, 2, 3, 4, latched=True, depth=2).write(tmp_path / "bag")
    (file,) = files(folder, ".mcap")
    content = file.read_bytes()
    # Depth 0 is unknown, or that of a publisher that keeps all: one message at least.
    file.write_bytes(content.replace(b"depth: 2", b"depth: 0"))
    for path, expected in ((folder, ["4"]), (file, ["4"])):
        bag = open_bag(path)
        bag.play(4)
        bag.want("/words")
        assert bag.texts() == expected


def test_a_publisher_of_unknown_depth_latches_one_message(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    folder = strings(0, 1, 2, 3, 4, latched=True, depth=2).write(tmp_path / "bag")
    (file,) = files(folder, ".mcap")
    content = file.read_bytes()
    start = content.index(b"- avoid_ros")
    end = content.index(b"reliability: reliable", start) + len(b"reliability: reliable")
    both = b"[{depth: 0, durability: transient_local}, {depth: 2, durability: transient_local}]"
    file.write_bytes(content.replace(content[start:end], both.ljust(end - start)))
    bag = open_bag(file)
    bag.play(4)
    bag.want("/words")
    assert bag.texts() == ["2", "3", "4"]


def test_a_broken_message_of_the_clock_changes_no_time(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    recorded = strings(0, 3)
    recorded.add("/clock", "rosgraph_msgs/msg/Clock")
    recorded.put(0.5, "/clock", {"clock": {"sec": 10}})
    recorded.put(1.5, "/clock", b"\x00\x01\x00\x00\x01")
    bag = open_bag(recorded.write(tmp_path / "bag"))
    bag.want("/words")
    bag.play(2)
    assert bag.source.now_ns() == ns(10)


def test_the_offset_of_simulated_time_is_that_of_the_first_stamped_transform(
    tmp_path: Path, open_bag: Callable[..., PlayedBag]
) -> None:
    recorded = Bag()
    recorded.add("/tf", TF)
    recorded.put(1, "/tf", {"transforms": [stamped("map", "base", 0)]})
    recorded.put(2, "/tf", {"transforms": [stamped("map", "base", ns(102))]})
    bag = open_bag(recorded.write(tmp_path / "bag"))
    bag.play(1.5)  # from the first message on
    assert bag.source.now_ns() == ns(102.5)


def test_a_renewed_subscription_does_not_read_the_beginning_again(
    tmp_path: Path, open_bag: Callable[..., PlayedBag], monkeypatch: pytest.MonkeyPatch
) -> None:
    bag = open_bag(strings(0, 1, 2).write(tmp_path / "bag"))
    read = []
    messages = BagHistory.messages

    def counting(
        bag: BagHistory, channels: Collection[HistoryChannel], *span: int
    ) -> Iterator[Recorded]:
        read.append([each.topic for each in channels])
        return messages(bag, channels, *span)

    monkeypatch.setattr(BagHistory, "messages", counting)
    bag.want("/words")
    bag.source.offers()
    before = len(read)
    bag.want("/words", resubscriptions=1)
    bag.source.offers()
    assert read[before:] == []
