"""Values the Text display reads from messages of any type."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import texts
from inspecting import Benches

from webviz import Topic
from webviz.api.pictures import Readout
from webviz.data.messages import encode
from webviz.shell.pictures.dock import written
from webviz.shell.testing import DisplayBench
from webviz.sources import Offer, Publisher
from webviz_displays.text import MAX_FIELDS, Text

BATTERY = "sensor_msgs/msg/BatteryState"
STRING = "std_msgs/msg/String"
JOINTS = "sensor_msgs/msg/JointState"


@pytest.fixture
def at(bench: Benches) -> DisplayBench:
    return bench(Text(topic=Topic("/any")))


def readout(at: DisplayBench) -> Readout:
    pane = at.nodes()["pane"]
    assert isinstance(pane.picture, Readout)
    return pane.picture


def text(at: DisplayBench) -> dict[str, Any]:
    tree = readout(at).tree()
    assert isinstance(tree, dict)
    return tree["fields"]


def send(at: DisplayBench, type_: str, values: dict[str, Any], **options: Any) -> None:
    at.send(type_, values, **options)
    at.turn()


def test_a_message_of_any_type_is_read_out(at: DisplayBench) -> None:
    values = {"voltage": 12.3456789, "cell_voltage": np.linspace(3, 4, 30), "present": True}
    send(at, BATTERY, values, frame="nowhere", stamp_ns=1_700_000_000_250_000_000)
    printout = text(at)
    assert printout["header"]["fields"]["stamp"] == "2023-11-14 22:13:20.250 UTC"
    assert (printout["voltage"], printout["present"]) == ("12.3457", "True")
    assert (printout["cell_voltage"]["length"], len(printout["cell_voltage"]["items"])) == (30, 20)
    assert readout(at).topic == "/any"
    assert at.statuses()["Fields"] == ("OK", f"All fields of {BATTERY}.")
    assert at.runner.subscriptions()["/any"].type == BATTERY
    assert all(level == "OK" for level, _ in at.statuses().values())


def test_fields_are_chosen_by_path_and_arrays_shortened(at: DisplayBench) -> None:
    send(at, JOINTS, {"name": ["left", "right"], "position": [0.25, 1e308], "effort": [1.0] * 50})
    at.set("array_length", 3)
    at.set("digits", 3)
    at.set("fields", ["position[right]", "effort"])
    assert text(at) == {
        "position[right]": "1e+308",
        "effort": {"length": 50, "type": "float64", "items": ["1", "1", "1"]},
    }
    assert at.statuses()["Fields"] == ("OK", f"2 fields of {JOINTS}.")


def test_a_field_that_is_not_there_is_named(at: DisplayBench) -> None:
    send(at, STRING, {"data": "hello"})
    at.set("fields", ["data", "data.x", "[", *["data"] * MAX_FIELDS])
    assert text(at) == {"data": "'hello'"}
    level, sentence = at.statuses()["Fields"]
    assert (level, sentence.endswith("And 2 more.")) == ("WARN", True)
    assert "`[` is not the path of a field" in sentence
    at.set("fields", ["speed"])
    assert at.nodes() == {}
    assert at.statuses()["Fields"][0] == "ERROR"


def test_a_topic_that_changes_its_type_is_read_as_the_new_one(at: DisplayBench) -> None:
    for type_, values in ((STRING, {"data": "hello"}), (BATTERY, {}), (STRING, {"data": "again"})):
        send(at, type_, values)
        assert readout(at).type == type_
        assert at.runner.subscriptions()["/any"].type == type_


def test_a_topic_that_another_display_reads_is_read_as_the_same_type(at: DisplayBench) -> None:
    publishers = tuple(Publisher("/a", each, "reliable", "volatile") for each in (BATTERY, STRING))
    at.offers["/any"] = Offer(publishers, type=STRING)
    at.turn()
    assert at.runner.subscriptions()["/any"].type == STRING


def test_undecodable_bytes_and_unknown_types_are_errors(at: DisplayBench) -> None:
    at.send_bytes(STRING, b"\0\1\0\0\xff\xff\xff\xff")
    at.turn()
    level, sentence = at.statuses()["Message"]
    assert (level, sentence.startswith(f"Not a {STRING}")) == ("ERROR", True)
    at.send_bytes("secret_msgs/msg/Thing", encode(STRING, {"data": "?"}))
    at.turn()
    sentence = "No definition of the message type secret_msgs/msg/Thing is known."
    assert at.statuses()["Message"] == ("ERROR", sentence)


def test_without_a_topic_or_publisher_nothing_is_subscribed_with_the_reason(
    bench: Benches,
) -> None:
    for topic, reason in ((Topic(), "No topic."), (Topic("/any"), "No publisher on /any.")):
        at = bench(Text(topic=topic))
        at.turn()
        assert at.runner.subscriptions() == {}
        assert reason in at.statuses()["Topic"][1]


def test_the_newest_message_is_shown_but_not_too_often(at: DisplayBench) -> None:
    for seconds, word, expected in (
        (0.0, "one", "one"),
        (0.05, "two", "one"),
        (0.06, "three", "three"),
        (-50.0, "back", "back"),
    ):
        at.turn(seconds)
        send(at, STRING, {"data": word})
        assert text(at) == {"data": repr(expected)}
    at.turn(0.01)
    send(at, STRING, {"data": "last"})
    at.turn(0.1)
    assert text(at) == {"data": "'last'"}, "also if no other message follows"


def test_a_large_message_is_cut(at: DisplayBench) -> None:
    send(at, STRING, {"data": "x" * 1_000_000})
    assert len(text(at)["data"]) < 500


def test_pictures_have_the_text_too(at: DisplayBench) -> None:
    send(at, JOINTS, {"name": ["left"], "position": [0.25]}, frame="base")
    picture = np.asarray(written(readout(at), (200, 120)))
    assert picture.shape == (120, 200, 3)
    assert (picture.max(axis=(1, 2)) > 200).sum() > 20


class TestText(BuiltInChecks):
    display = Text
    scene = texts
    later = ("update_interval",)
    needs: ClassVar = {
        "enabled": {"topic": Topic("/any")},
        "topic": {"topic": Topic("/any")},
        "fields": {"topic": Topic("/any")},
        "digits": {"topic": Topic("/any")},
        "array_length": {"topic": Topic("/any")},
        "update_interval": {"topic": Topic("/any")},
    }
    values: ClassVar = {"fields": [["voltage"]]}
