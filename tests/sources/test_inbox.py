"""Messages the inbox keeps until the next tick."""

from __future__ import annotations

from webviz.sources import Raw
from webviz.sources.inbox import Inbox


def put(inbox: Inbox, topic: str, *sizes: int) -> None:
    for size in sizes:
        inbox.put(topic, Raw(bytes(size), 0))


def payload_sizes(inbox: Inbox) -> dict[str, list[int]]:
    return {topic: [len(raw.cdr) for raw in raws] for topic, raws in inbox.drain().items()}


def make_inbox(max_bytes: int, max_total: int) -> Inbox:
    inbox = Inbox(max_bytes, max_total)
    for topic in ("/a", "/b", "/c"):
        inbox.open(topic, 10)
    return inbox


def test_a_topic_keeps_its_newest_message_however_large() -> None:
    inbox = make_inbox(100, 1000)
    put(inbox, "/a", 60, 50, 40)
    assert payload_sizes(inbox) == {"/a": [50, 40]}
    put(inbox, "/a", 60, 500)
    assert payload_sizes(inbox) == {"/a": [500]}
    assert inbox.dropped("/a") == 2


def test_a_topic_keeps_its_newest_messages_up_to_a_number() -> None:
    inbox = make_inbox(1000, 1000)
    put(inbox, "/a", *range(1, 13))
    put(inbox, "/closed", 1)
    assert payload_sizes(inbox) == {"/a": list(range(3, 13))}
    assert inbox.dropped("/a") == 2
    assert inbox.received() == {"/a": (12, sum(range(1, 13))), "/b": (0, 0), "/c": (0, 0)}


def test_all_topics_share_a_limit_and_the_one_with_most_bytes_loses_its_oldest() -> None:
    inbox = make_inbox(100, 150)
    put(inbox, "/a", 40, 50)
    put(inbox, "/b", 60)
    assert inbox.dropped("/a") == 0
    put(inbox, "/c", 10)
    assert payload_sizes(inbox) == {"/a": [50], "/b": [60], "/c": [10]}
    assert inbox.dropped("/a") == 1
    put(inbox, "/a", 100)
    put(inbox, "/b", 50)
    assert payload_sizes(inbox) == {"/a": [100], "/b": [50]}


def test_the_limit_of_all_topics_holds_for_a_single_message_only_beside_others() -> None:
    inbox = make_inbox(100, 150)
    put(inbox, "/a", 400)
    assert payload_sizes(inbox) == {"/a": [400]}
    put(inbox, "/a", 90)
    put(inbox, "/b", 400)
    assert payload_sizes(inbox) == {"/a": [90], "/b": []}
    assert inbox.dropped("/b") == 1


def test_a_closed_topic_makes_room() -> None:
    inbox = make_inbox(100, 150)
    put(inbox, "/a", 100)
    inbox.close("/a")
    put(inbox, "/b", 90)
    put(inbox, "/c", 60)
    assert payload_sizes(inbox) == {"/b": [90], "/c": [60]}


def test_messages_and_bytes_are_counted_until_a_topic_is_closed() -> None:
    inbox = make_inbox(100, 1000)
    put(inbox, "/a", 60, 50, 40)
    put(inbox, "/b", 5)
    inbox.drain()
    assert inbox.received() == {"/a": (3, 150), "/b": (1, 5), "/c": (0, 0)}
    inbox.close("/a")
    assert inbox.received() == {"/b": (1, 5), "/c": (0, 0)}
