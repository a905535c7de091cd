"""The sentences below a display: what is wrong with a topic, and that they go away."""

from __future__ import annotations

import time
from typing import Annotated, Any

import pytest
from bench import Bench, Benches
from dots import POSE, SECOND, PoseDot, T, show_dot

from webviz import Context, Display, Input, Sample, Topic
from webviz.api.status import OtherFixedFrame, Remedy
from webviz.commands import SetFixedFrame, SetProperty
from webviz.data.transforms import filter as transform_filter
from webviz.engine.pipeline.input_subscription import DROPS_S, Drops
from webviz.engine.pipeline.topic_statistics import TopicStatistics
from webviz.shell.testing.messages import header
from webviz.sources import Offer, Publisher, Raw
from webviz_displays.path import Path


def offer(
    type_name: str = POSE,
    reliability: Any = "reliable",
    durability: Any = "volatile",
    requested: Any = ("reliable", "volatile"),
) -> Offer:
    return Offer((Publisher("/talker", type_name, reliability, durability),), requested)


def test_a_topic_without_publishers(b: Bench) -> None:
    assert b.statuses()["Topic"] == (
        "WARN",
        "No publisher on /pose. Start the node that publishes it or choose another topic.",
    )


def test_a_topic_without_publishers_suggests_another_of_its_type(b: Bench) -> None:
    b.source.topics = {"/another": offer(), "/goal_pose": offer()}
    text = "No publisher on /pose. Choose /goal_pose, the nearest topic of its type."
    assert b.statuses()["Topic"] == ("WARN", text)
    remedy = b.states[-1].rows[0].statuses["Topic"].remedy
    assert remedy == Remedy("topic.name", "/goal_pose", "Use /goal_pose")


def test_another_type_names_both(b: Bench) -> None:
    b.source.topics["/pose"] = offer("nav_msgs/msg/Odometry")
    level, text = b.statuses()["Topic"]
    assert level == "ERROR"
    assert "has the type nav_msgs/msg/Odometry" in text
    assert f"shows {POSE}" in text


@pytest.mark.parametrize("name", ["", "a b"])
def test_an_invalid_topic_name(bench: Benches, name: str) -> None:
    b = bench(PoseDot(name="Dot", topic=Topic(name)))
    level, text = b.statuses()["Topic"]
    assert level == "ERROR"
    assert text in ("No topic. Choose one.", "'a b' is not a valid topic name: it has a space")


def test_qos_that_cannot_connect_names_both_sides_and_the_remedy(bench: Benches) -> None:
    b = bench(PoseDot(name="Dot", topic=Topic("/pose", reliability="reliable")))
    b.source.topics["/pose"] = offer(reliability="best_effort")
    level, text = b.statuses()["Topic"]
    assert level == "ERROR"
    assert "requests reliable, volatile" in text
    assert "offers best effort, volatile" in text
    assert "Set reliability and durability to auto." in text
    remedy = b.states[-1].rows[0].statuses["Topic"].remedy
    assert isinstance(remedy, Remedy)
    assert remedy.label == "Set QoS to automatic"
    b.do(SetProperty("display1", remedy.path, remedy.value))
    assert b.source.subscriptions["/pose"].topic == Topic("/pose")


def test_a_problem_of_the_source_is_reported(b: Bench) -> None:
    b.source.topics["/pose"] = Offer((), None, "cannot subscribe: no such type")
    assert b.statuses()["Topic"] == ("ERROR", "/pose: cannot subscribe: no such type")


def test_no_message_yet_names_the_publisher_and_its_qos(b: Bench) -> None:
    b.source.topics["/pose"] = offer()
    text = "No message yet on /pose from /talker (reliable, volatile)."
    assert b.statuses()["Topic"] == ("WARN", text)


def test_silence_after_a_stream_and_a_publisher_that_left(b: Bench) -> None:
    b.transform("map", "base", T, static=True)
    for _ in range(10):
        b.pose("/pose", "base", T)
        b.turn()
        b.clock += 0.1
    level, text = b.statuses()["Topic"]
    assert (level, text.startswith("10 messages at 10.0 Hz")) == ("OK", True)
    b.clock += 5.0
    assert b.statuses()["Topic"][0] == "OK"  # simulated time stands still, so nothing is late
    b.source.now += 3 * SECOND // 2
    assert b.statuses()["Topic"][0] == "OK"  # simulated time is slow
    b.source.now += 5 * SECOND
    level, text = b.statuses()["Topic"]
    assert (level, text.startswith("No message for 5.1 s on /pose, previously at 10.0 Hz")) == (
        "WARN",
        True,
    )
    b.source.topics["/pose"] = Offer(())
    level, text = b.statuses()["Topic"]
    assert level == "WARN"
    assert text == "No publisher on /pose any more, last message 5.1 s ago. Restart it."
    measured = b.states[-1].rows[0].statuses["Topic"].values
    assert [(each.name, each.value, each.unit) for each in measured] == [
        ("messages", 10, ""),
        ("rate", 10.0, "Hz"),
        ("age", 5.1, "s"),
    ]


def test_a_slow_stream_is_late_after_five_of_its_gaps(b: Bench) -> None:
    b.transform("map", "base", T, static=True)

    def wait(seconds: int) -> str:
        b.clock += seconds
        b.source.now += seconds * SECOND
        return b.statuses()["Topic"][0]

    for _ in range(6):
        wait(2)
        b.pose("/pose", "base", T)
        b.turn()
    assert (wait(9), wait(2)) == ("OK", "WARN")


def test_messages_without_a_header_are_numbered_as_they_come(bench: Benches) -> None:
    numbers: list[int] = []

    class Note(Display):
        """Nothing of a text."""

        topic: Annotated[Topic, Input("std_msgs/msg/String")] = Topic("/note")

        def draw(self, sample: Sample, ctx: Context) -> None:
            numbers.append(sample.number)

    b = bench(Note(name="Note"))
    for _ in range(3):
        b.publish("/note", "std_msgs/msg/String", {"data": "x"})
        b.turn()
    assert numbers == [0, 1, 2]


def test_plans_and_bursts_have_no_rate(bench: Benches) -> None:
    b = bench(Path(name="Path"), PoseDot(name="Dot"))
    b.transform("map", "base", T, static=True)
    for pause in (0.1, 0.1, 0.1, 0.1, 0.1, 60.0):
        b.publish("/path", "nav_msgs/msg/Path", {"header": header("map", T)})
        b.turn()
        b.clock += pause
        b.source.now += int(pause * SECOND)
    assert b.statuses()["Topic"][0] == "OK"
    for pause in (0.1, 0.1, 0.1, 60.0):
        b.pose("/pose", "base", T)
        b.turn()
        b.clock += pause
        b.source.now += int(pause * SECOND)
    level, text = b.statuses(1)["Topic"]
    assert (level, " Hz" in text) == ("OK", False)


def test_messages_that_waited_together_have_the_rate_they_arrived_at(b: Bench) -> None:
    b.transform("map", "base", T, static=True)
    b.pose("/pose", "base", T)
    cdr = b.source.inbox.drain()["/pose"][0].cdr
    for number in range(31):  # at 3 Hz, for 10 s in which they were not taken
        arrived_s = time.monotonic() - (30 - number) / 3
        b.source.inbox.put("/pose", Raw(cdr, b.source.now, arrived_s))
    assert "31 messages at 3.0 Hz" in b.statuses()["Topic"][1]


@pytest.mark.parametrize(("is_latched", "payload"), [(False, b""), (True, b"1234")])
def test_only_the_bytes_of_latched_messages_are_kept(is_latched: bool, payload: bytes) -> None:
    topic_statistics = TopicStatistics("topic", Input(POSE), Topic("/pose"), "/pose", "")
    topic_statistics.note(Raw(b"1234", 0), 0.0, is_latched)
    assert topic_statistics.last is not None
    assert topic_statistics.last.cdr == payload


def test_one_latched_message_is_not_silence(b: Bench) -> None:
    show_dot(b)
    b.clock += 500.0
    level, text = b.statuses()["Topic"]
    assert (level, "the newest 500.0 s ago" in text) == ("OK", True)


def test_a_missing_transform_is_explained_after_a_second_and_forgotten_when_it_comes(
    b: Bench,
) -> None:
    b.transform("map", "base_link", T, static=True)
    b.pose("/pose", "base", T)
    assert b.statuses()["Transform"][0] == "IDLE"
    b.clock += 1.1
    level, text = b.statuses()["Transform"]
    assert level == "ERROR"
    assert text.startswith('Frame "base" does not exist: no transform to it has arrived.')
    b.transform("map", "base", T, static=True)
    assert b.statuses()["Transform"] == ("OK", "Transform OK")


def test_messages_that_wait_for_a_transform_are_bounded_in_bytes(
    b: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(transform_filter, "MAX_BYTES", 150)
    for number in range(3):
        b.pose("/pose", "base", T + number, float(number))
    b.turn()
    b.clock += 1.5
    b.turn()
    level, text = b.statuses()["Transform"]
    assert (level, text.endswith("2 messages were given up.")) == ("ERROR", True), text


def test_the_root_of_the_other_tree_is_offered_as_fixed_frame(b: Bench) -> None:
    b.transform("map", "base_link", T, static=True)
    b.transform("world", "drone", T, static=True)
    b.pose("/pose", "drone", T)
    b.statuses()
    b.clock += 1.1
    level, text = b.statuses()["Transform"]
    assert (level, "in two trees" in text) == ("ERROR", True)
    remedy = b.states[-1].rows[0].statuses["Transform"].remedy
    assert remedy == OtherFixedFrame("world")
    b.do(SetFixedFrame("world"))
    assert b.statuses()["Transform"] == ("OK", "Transform OK")


def test_transforms_that_come_long_after_the_data_are_a_warning_until_they_keep_up(
    b: Bench,
) -> None:
    late_ns = 6 * SECOND // 10
    for _ in range(20):
        b.source.now += SECOND // 10
        b.clock += 0.1
        b.transform("map", "base", b.source.now - late_ns)
        b.pose("/pose", "base", b.source.now)
        b.turn()
    level, text = b.statuses()["Transform"]
    assert level == "WARN"
    assert text.startswith(
        "Drawn 600 ms late: the transforms arrive that long after the data. The stamp"
    )
    assert '"map" → "base" (from /test)' in text
    for _ in range(3):
        b.source.now += SECOND // 10
        b.clock += 0.1
        b.transform("map", "base", b.source.now)
        b.pose("/pose", "base", b.source.now)
        b.turn()
    assert b.statuses()["Transform"] == ("OK", "Transform OK")


def test_the_warning_of_one_early_message_ends_soon(b: Bench) -> None:
    b.pose("/pose", "base", T)
    b.turn()
    b.source.now += SECOND // 2
    b.transform("map", "base", T, static=True)
    assert b.statuses()["Transform"][0] == "WARN"
    b.clock += 1.1
    b.source.now += SECOND + SECOND // 10
    assert b.statuses()["Transform"] == ("OK", "Transform OK")


def test_messages_that_did_not_fit_the_inbox_are_counted(b: Bench) -> None:
    b.transform("map", "base", T, static=True)
    b.turn()
    for _ in range(1005):
        b.pose("/pose", "base", T)
    level, text = b.statuses()["Message"]
    assert level == "WARN"
    assert text == "5 messages dropped: they arrive faster than they can be read."
    b.clock += 9.0
    assert "Message" in b.statuses()
    b.clock += 9.0
    assert "Message" not in b.statuses()  # it was once
    for _ in range(1001):
        b.pose("/pose", "base", T)
    assert b.statuses()["Message"][1].startswith("1 message dropped")


def test_messages_that_were_dropped_before_the_first_look_count() -> None:
    drops = Drops()
    assert [drops.recent(1, at) for at in (100.0, 101.0, 100.0 + DROPS_S)] == [1, 1, 1]
    assert drops.recent(1, 100.1 + DROPS_S) == 0


def test_a_flood_of_junk_leaves_the_viewer_running(b: Bench) -> None:
    for size in range(200):
        b.source.inbox.put("/pose", Raw(bytes(size), T))
    b.turn()
    assert b.statuses()["Message"][0] == "ERROR"


def test_a_topic_that_another_display_reads_as_another_type(b: Bench) -> None:
    b.transform("map", "base", T, static=True)
    b.source.topics["/pose"] = Offer((), ("reliable", "volatile"), type="nav_msgs/msg/Odometry")
    b.source.inbox.put("/pose", Raw(bytes(100), T))
    level, text = b.statuses()["Topic"]
    assert level == "ERROR"
    assert "reads /pose as nav_msgs/msg/Odometry" in text
    assert f"shows {POSE}" in text
    assert "Message" not in b.statuses()


def test_waiting_messages_are_dropped_when_time_jumps_back(b: Bench) -> None:
    b.transform("map", "base", T - 2 * SECOND)
    b.pose("/pose", "base", T, x=7.0)
    b.turn()
    b.source.now = T - 5 * SECOND
    b.turn()
    for stamp_ns in (T - SECOND, T + SECOND):  # would place what waited
        b.transform("map", "base", stamp_ns)
    b.turn()
    assert list(b.scene.visible()) == []
    assert b.statuses()["Topic"][1].startswith("No message yet")  # as in RViz after a reset


def test_the_wait_for_transforms_restarts_when_time_jumps_back(b: Bench) -> None:
    b.transform("map", "odom", T, static=True)
    b.pose("/pose", "base", T)
    b.turn()
    b.clock += 60.0
    assert b.statuses()["Transform"][0] == "ERROR"
    b.source.now = T - 5 * SECOND
    b.turn()
    b.pose("/pose", "base", b.source.now)
    assert b.statuses()["Transform"][0] == "IDLE"
