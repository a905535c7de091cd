"""Messages that wait for their transform: tf2_ros' test_message_filter without callbacks."""

import pytest

from tests.data.transforms.conftest import HandFedBuffer
from webviz.data.transforms import Kind, MessageFilter, TransformBuffer
from webviz.data.transforms import filter as filter_module

S = 1_000_000_000


@pytest.fixture
def messages() -> MessageFilter[str]:
    return MessageFilter(10)


def test_without_transforms_a_message_waits(
    buffer: TransformBuffer, messages: MessageFilter[str]
) -> None:
    messages.add("m", "laser", S)
    assert messages.ready(buffer, "map") == []
    assert len(messages) == 1
    assert messages.is_stuck


def test_a_message_in_the_fixed_frame_passes_without_any_transform(
    buffer: TransformBuffer, messages: MessageFilter[str]
) -> None:
    messages.add("m", "map", S)
    assert messages.ready(buffer, "map") == ["m"]
    assert not messages.is_stuck


def test_a_message_passes_at_once_if_its_transform_is_there(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    buffer.put("map", "laser", 1.0)
    messages.add("m", "laser", S)
    assert messages.ready(buffer, "map") == ["m"]


def test_the_first_message_since_the_last_that_was_ready_is_known(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    assert messages.stuck_since is None
    buffer.put("map", "laser", 1.0)
    for name, at_s in (("ready", 1), ("first", 2), ("second", 3)):
        messages.add(name, "laser", at_s * S)
        messages.ready(buffer, "map")
    assert messages.stuck_since == "first"
    buffer.put("map", "laser", 3.0)
    assert messages.ready(buffer, "map") == ["first", "second"]
    assert messages.stuck_since is None


def test_a_message_passes_when_its_transform_comes_and_only_once(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    messages.add("m", "laser", S)
    assert messages.ready(buffer, "map") == []
    buffer.put("map", "laser", 1.0)
    assert messages.ready(buffer, "map") == ["m"]
    assert messages.ready(buffer, "map") == []
    assert not messages.is_stuck


def test_messages_become_ready_in_order_of_arrival(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    buffer.put("map", "laser", 1.0)
    for name, stamp in (("a", 1.5), ("b", 1.7), ("c", 1.6), ("d", 2.5)):
        messages.add(name, "laser", round(stamp * S))
    assert messages.ready(buffer, "map") == []
    buffer.put("map", "laser", 2.0)
    assert messages.ready(buffer, "map") == ["a", "b", "c"]


def test_a_leading_slash_of_a_message_is_stripped(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    buffer.put("map", "laser", 1.0)
    messages.add("m", "/laser", S)
    assert messages.ready(buffer, "map") == ["m"]


def test_a_zero_stamp_means_the_latest_transform(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    messages.add("m", "laser", 0)
    assert messages.ready(buffer, "map") == []
    buffer.put("map", "laser", 100.0)
    assert messages.ready(buffer, "map") == ["m"]


def test_another_fixed_frame_applies_to_those_that_wait(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    buffer.put("odom", "laser", 1.0)
    messages.add("m", "laser", S)
    assert messages.ready(buffer, "map") == []
    assert messages.ready(buffer, "odom") == ["m"]


def test_a_message_with_a_duration_waits_for_its_end_too(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    buffer.put("map", "laser", 1.0)
    buffer.put("map", "laser", 1.1)
    messages.add("scan", "laser", S, duration_ns=S // 5)
    assert messages.ready(buffer, "map") == []
    explanation = messages.explanation(buffer, "map")
    assert explanation is not None
    assert explanation.kind == Kind.AHEAD
    buffer.put("map", "laser", 1.2)
    assert messages.ready(buffer, "map") == ["scan"]


def test_stamps_keep_their_last_nanosecond(
    buffer: TransformBuffer, messages: MessageFilter[str]
) -> None:
    stamp = 1_000_000_000 * S + 1
    buffer.set_transform("map", "laser", stamp, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    messages.add("exact", "laser", stamp)
    messages.add("one off", "laser", stamp + 1)
    assert messages.ready(buffer, "map") == ["exact"]


def test_a_ready_message_takes_no_place_in_a_full_queue(buffer: HandFedBuffer) -> None:
    messages: MessageFilter[int] = MessageFilter(3)
    buffer.put("map", "laser", 1.0)
    buffer.put("map", "camera", 1.0)
    for i in range(3):
        messages.add(i, "laser", 2 * S)
    for i in range(3, 20):
        messages.add(i, "camera", S)
    assert messages.ready(buffer, "map") == list(range(3, 20))
    buffer.put("map", "laser", 2.0)
    assert messages.ready(buffer, "map") == [0, 1, 2]
    assert not messages.drops


def test_a_full_queue_drops_its_oldest_message(buffer: HandFedBuffer) -> None:
    messages: MessageFilter[int] = MessageFilter(3)
    for i in range(5):
        messages.add(i, "laser", S)
    assert messages.ready(buffer, "map") == []
    assert messages.drops == {Kind.QUEUE_FULL: 2}
    buffer.put("map", "laser", 1.0)
    assert messages.ready(buffer, "map") == [2, 3, 4]


def test_the_oldest_message_over_the_limit_of_bytes_is_dropped_with_the_cause(
    buffer: HandFedBuffer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(filter_module, "MAX_BYTES", 100)
    messages: MessageFilter[int] = MessageFilter(10)
    buffer.put("map", "laser", 1.0)
    for i in range(5):
        messages.add(i, "laser", 2 * S, 2 * S, size=40)
    assert messages.ready(buffer, "map", 2 * S) == []
    assert messages.drops == {Kind.QUEUE_FULL: 3}
    explanation = messages.explanation(buffer, "map", 2 * S)
    assert explanation is not None
    assert "of messages wait before their transforms arrive: speed up" in explanation.sentence
    assert "3 messages were given up." in explanation.sentence
    messages.add(5, "laser", 2 * S, 2 * S, size=1000)
    assert messages.ready(buffer, "map", 2 * S) == []
    buffer.put("map", "laser", 2.0)
    assert messages.ready(buffer, "map", 2 * S) == [5]


def test_with_transforms_that_come_late_newer_messages_displace_nothing(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    delivered = []
    for tick in range(100):  # 100 Hz ticks, a scan every 4, its transform 3 ticks late
        now = 10.0 + tick / 100
        buffer.put("map", "laser", now - 0.03)
        if tick % 4 == 0:
            messages.add(str(tick), "laser", round(now * S))
        delivered += messages.ready(buffer, "map")
    assert len(delivered) >= 24


def test_an_empty_frame_is_given_up_at_once(
    buffer: TransformBuffer, messages: MessageFilter[str]
) -> None:
    messages.add("m", "", S)
    assert messages.ready(buffer, "map") == []
    assert messages.drops == {Kind.EMPTY_FRAME: 1}
    explanation = messages.explanation(buffer, "map")
    assert explanation is not None
    assert explanation.kind == Kind.EMPTY_FRAME


def test_a_message_older_than_anything_that_can_come_is_given_up(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    buffer.put("map", "laser", 100.0)
    buffer.put("map", "laser", 101.0)
    messages.add("m", "laser", 90 * S)
    assert messages.ready(buffer, "map") == []
    assert messages.drops == {Kind.BEHIND: 1}
    assert len(messages) == 0
    explanation = messages.explanation(buffer, "map", 101 * S)
    assert explanation is not None
    assert explanation.kind == Kind.BEHIND
    assert explanation.sentence.endswith("1 message was given up.")


def test_a_stamp_before_1970_is_older_than_anything_that_can_come(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    buffer.put("map", "laser", 100.0)
    messages.add("m", "laser", -S)
    assert messages.ready(buffer, "map") == []
    assert messages.drops == {Kind.BEHIND: 1}


def test_the_state_clears_when_data_flows_again(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    for i in range(20):
        messages.add(str(i), "laser", S)
    messages.ready(buffer, "map")
    explanation = messages.explanation(buffer, "map")
    assert explanation is not None
    assert explanation.kind == Kind.NO_TRANSFORMS
    assert explanation.sentence.endswith("10 messages were given up.")
    buffer.put("map", "laser", 1.0)
    assert len(messages.ready(buffer, "map")) == 10
    assert messages.explanation(buffer, "map") is None
    assert not messages.is_stuck


def test_a_message_before_the_first_transform_is_ignored_once_a_newer_one_is_ready(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    buffer.put("map", "laser", 1.0)
    buffer.put("map", "laser", 3.0)
    messages.add("first", "laser", round(0.95 * S))
    assert messages.ready(buffer, "map") == []
    reason = messages.explanation(buffer, "map")
    assert reason
    assert reason.kind is Kind.BEHIND
    messages.add("other frame", "nowhere", S)
    messages.add("second", "laser", 2 * S)
    assert messages.ready(buffer, "map") == ["second"]
    reason = messages.explanation(buffer, "map")
    assert reason
    assert reason.kind is Kind.UNKNOWN_FRAME
    messages.add("one more", "laser", 3 * S)
    messages.add("back again", "laser", round(0.9 * S))
    assert messages.ready(buffer, "map") == ["one more"]
    buffer.put("map", "nowhere", 1.0)
    assert messages.ready(buffer, "map") == ["other frame"]
    reason = messages.explanation(buffer, "map")  # of what arrived after newer data
    assert reason
    assert reason.kind is Kind.BEHIND
    assert messages.is_stuck


def test_a_queue_too_short_for_the_lag_is_reported_with_the_length_it_needs(
    buffer: HandFedBuffer,
) -> None:
    messages: MessageFilter[str] = MessageFilter(5)
    buffer.put("map", "laser", 9.0)
    for i in range(40):  # 50 Hz, 300 ms late
        now = 10.0 + i / 50
        buffer.put("map", "laser", now - 0.3)
        messages.add("m", "laser", round(now * S))
        assert messages.ready(buffer, "map", round(now * S)) == []
    explanation = messages.explanation(buffer, "map", round(10.78 * S))
    assert explanation is not None
    assert explanation.kind == Kind.QUEUE_FULL
    assert "300 ms late" in explanation.sentence
    assert "raise the filter size to 17" in explanation.sentence
    assert explanation.filter_size == 17
    enough: MessageFilter[str] = MessageFilter(17)
    flowed = []
    for i in range(40, 80):
        now = 10.0 + i / 50
        buffer.put("map", "laser", now - 0.3)
        enough.add("m", "laser", round(now * S))
        flowed += enough.ready(buffer, "map", round(now * S))
    assert flowed
    assert not enough.drops


def test_clear_forgets_messages_and_counts(
    buffer: HandFedBuffer, messages: MessageFilter[str]
) -> None:
    for _ in range(15):
        messages.add("m", "laser", S)
    messages.ready(buffer, "map")
    messages.clear()
    buffer.put("map", "laser", 1.0)
    assert messages.ready(buffer, "map") == []
    assert not messages.drops
    assert not messages.is_stuck
