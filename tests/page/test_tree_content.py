"""The content of the tree of displays."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Any

import msgspec
import pytest
from msgspec.structs import replace
from page_stores import page_store

from tests.page.everything import make_row
from tests.support.given_parts import GivenParts
from webviz.api.declared import Topic
from webviz.api.group import DisplayGroup
from webviz.api.offer import Offer, Publisher
from webviz.api.status import Level, OtherFixedFrame, Remedy, Status
from webviz.data.transforms.reasons import Explanation, Kind
from webviz.engine.state import Row, State, Traffic
from webviz.page import pages as pages_module
from webviz.page.pages import Pages
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import ToPage
from webviz.server.channel.stores import Stores

MakeRow = Callable[..., Row]
STATUSES = {
    "Topic": Status(Level.OK, "12 Hz"),
    "Points": Status(Level.WARN, "No points."),
    "Transform": Status(Level.ERROR, "No transform."),
    "Later": Status(Level.ERROR, "Another error."),
}


def row_of(row: Row) -> dict[str, object]:
    return page_store("displays", State(rows=(row,)))[row.id]


def test_a_row_says_its_worst_status_and_nothing_while_all_is_well() -> None:
    assert row_of(make_row("a", statuses=STATUSES))["line"] == "No transform."
    assert row_of(make_row("a", statuses=STATUSES))["level"] == "error"
    assert row_of(make_row("a", statuses={"Topic": STATUSES["Topic"]}))["line"] == ""


def test_a_group_names_the_display_that_has_the_problem() -> None:
    group = Row("g", "Group", DisplayGroup(name="G"), "G", {"Front scan": STATUSES["Points"]})
    assert row_of(group)["line"] == "Front scan: No points."


def test_a_row_offers_what_helps() -> None:
    remedy = Remedy("topic.name", "/front", "Use /front")
    statuses = {"Topic": Status(Level.WARN, "No publisher.", remedy), "Later": STATUSES["Topic"]}
    fields = {"display": "a", "path": "topic.name", "value": "/front"}
    remedy_values = {"label": "Use /front", "command": "SetProperty", "arguments": [fields]}
    assert row_of(make_row("a", statuses=statuses))["remedy"] == remedy_values
    statuses["Later"] = STATUSES["Transform"]
    assert "remedy" not in row_of(make_row("a", statuses=statuses)), "it would not help yet"


def test_a_cause_that_the_viewer_names_is_said_once_and_its_remedy_offered_everywhere() -> None:
    reason = Explanation(Kind.UNKNOWN_FIXED_FRAME, "Fixed frame does not exist.")
    cause = Status(Level.ERROR, reason.sentence, OtherFixedFrame("odom"), reason)
    given_up = dataclasses.replace(reason, sentence=f"{reason.sentence} 3 messages were given up.")
    own = Status(Level.ERROR, given_up.sentence, reason=given_up)
    few = Status(Level.ERROR, "0 of 3 links.")  # first, and because of the cause
    rows = (
        make_row("a", statuses={"Links": few, "Transform": own}),
        make_row("b", statuses=STATUSES),
    )
    tree_store = page_store("displays", State(rows=rows, statuses={"Fixed Frame": cause}))
    assert (tree_store["a"]["line"], tree_store["a"]["level"]) == ("", "error")
    assert tree_store["b"]["line"] == "No transform."
    assert page_store("displays", State(rows=rows))["a"]["line"] == few.text
    remedy_values = {
        "label": "Use odom",
        "command": "SetFixedFrame",
        "arguments": [{"frame": "odom"}],
    }
    state = State(rows=rows, statuses={"Fixed Frame": cause})
    assert page_store("statuses", state, "a")["statuses"][1] == [
        "Transform",
        "error",
        own.text,
        remedy_values,
    ]
    assert page_store("settings", state)["statuses"][0][3] == remedy_values


def test_a_row_names_the_topics_that_it_listens_to() -> None:
    assert row_of(make_row("a", topic=Topic("/front")))["topics"] == ["/front"]
    assert row_of(make_row("a", topic=Topic("")))["topics"] == []
    assert row_of(Row("a", "", None, "Gone", {}))["topics"] == []


@pytest.mark.parametrize(
    ("hz", "rounded"), [(39.84, 40.0), (9.96, 10.0), (0.5349, 0.53), (123.4, 120.0), (0.0, 0.0)]
)
def test_a_rate_has_two_digits_so_that_it_changes_seldom(hz: float, rounded: float) -> None:
    state = State(rows=(make_row("a"),), traffic={"/scan": Traffic(hz, 1.0)})
    assert page_store("rate", state, "a") == {"hz": rounded}
    assert page_store("rate", state, "gone") == {}
    assert page_store("rate", replace(state, traffic={}), "a") == {}


def test_a_topic_whose_last_message_is_repeated_is_latched() -> None:
    publishers = (
        Publisher("/a", "sensor_msgs/msg/LaserScan", "reliable", "transient_local"),
        Publisher("/b", "sensor_msgs/msg/LaserScan", "reliable", "volatile"),
    )
    state = State(rows=(make_row("a"),), traffic={"/scan": Traffic(0.0, 0.0)})
    for count, expected in ((1, {"hz": 0.0, "is_latched": True}), (2, {"hz": 0.0})):
        offers = {"/scan": Offer(publishers[:count])}
        assert page_store("rate", replace(state, offers=offers), "a") == expected


class CountingChannel(Channel):
    """A channel of a page that watches the tree of displays."""

    def __init__(self) -> None:
        super().__init__()
        self.names = {"displays"}
        self.count = 0

    def watched(self) -> set[str]:
        return self.names

    def send(self, message: ToPage, browser: int | None = None) -> None:
        pass

    def show(self, store: str, values: Mapping[str, Any]) -> None:
        self.count += 1


def test_a_store_is_made_anew_only_if_what_it_is_made_of_is_new(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    channel, parts_bench = CountingChannel(), GivenParts()
    pages = Pages(channel, lambda command, sender: Future(), parts=parts_bench.parts)

    def count_after(state: State) -> int:
        parts_bench.show(state)
        pages.update()
        return channel.count

    state = State(rows=(make_row("a"),))
    assert count_after(state) == 1
    assert count_after(replace(state, rows=(*state.rows,), frames=("odom",))) == 1
    assert count_after(replace(state, rows=(make_row("b"),))) == 2
    channel.names = set()
    assert count_after(state) == 2
    channel.names = {"displays"}
    assert count_after(state) == 3, "nobody knows what the page had"
    monkeypatch.setattr(pages_module, "registered_types", lambda: {"file.py": {}})
    assert count_after(state) == 4, "there are other types of displays"


def test_half_a_surrogate_pair_reaches_the_page_as_it_is() -> None:
    stores = Stores()
    stores.replace("displays", {"a": {"name": "\ud800", "topics": ("x",)}})
    content = stores.get("displays")
    assert content is not None
    assert bytes(content["a"]) == b'{"name": "\\ud800", "topics": ["x"]}'
    assert msgspec.json.encode(content).isascii()


def test_of_too_many_statuses_the_worst_are_shown() -> None:
    statuses = {f"frame {i}": Status(Level.OK, "fine") for i in range(500)}
    statuses["last"] = Status(Level.ERROR, "lost")
    tree_store = page_store("statuses", State(rows=(make_row("a", statuses=statuses),)), "a")
    assert tree_store["statuses"][0] == ["last", "error", "lost", None]
    assert len(tree_store["statuses"]) + tree_store["more"] == 501
    assert tree_store["more"] > 400


def test_an_entry_that_cannot_be_read_says_why_and_has_nothing_to_edit() -> None:
    reason = Status(Level.ERROR, "displays[0]: unknown display type `Grd`, did you mean `Grid`?")
    row = Row("a", "Grd", None, "Ground", {"Config": reason})
    assert (row_of(row)["line"], row_of(row)["can_edit"]) == (reason.text, False)
    properties = page_store("properties", State(rows=(row,)), "a")
    assert properties["worst"]["text"] == reason.text
    assert "declared" not in properties
