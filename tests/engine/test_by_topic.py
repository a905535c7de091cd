"""Displays offered for topics."""

from __future__ import annotations

from typing import Annotated

from webviz.api.declared import Topic
from webviz.api.display import Display, Input, inputs_of
from webviz.api.ports import ANY, Namespace
from webviz.api.registry import display_types
from webviz.engine.parts.by_topic import Pick, no_display, picks

GRID = "nav_msgs/msg/OccupancyGrid"
UPDATE = "map_msgs/msg/OccupancyGridUpdate"


class Map(Display):
    topic: Annotated[Topic, Input(GRID)] = Topic("/map")
    updates: Annotated[Topic, Input(UPDATE, suffix="_updates")] = Topic()
    notes: Annotated[Topic, Input("std_msgs/msg/String", is_offered=False)] = Topic()


class Outline(Display):
    source: Annotated[Topic, Input(GRID)] = Topic()


class Description(Display):
    urdf: Annotated[Topic, Input("std_msgs/msg/String", offered_for="description")] = Topic()


class Handles(Display):
    of: str = ""
    offered_for = Namespace("of", "a/msg/Update", "/update")


class Anything(Display):
    topic: Annotated[Topic, Input(ANY)] = Topic()


DISPLAYS = {"Outline": Outline, "Map": Map}


def test_every_fitting_display_is_offered_and_unsupported_topics_are_not() -> None:
    topics = {"/map": (GRID,), "/chatter": ("std_msgs/msg/String",), "/map_updates": (UPDATE,)}
    assert picks(topics, DISPLAYS) == [
        Pick("/map", "Map", "topic", GRID),
        Pick("/map", "Outline", "source", GRID),
    ]


def test_a_topic_of_two_types_is_offered_for_the_one_that_can_be_shown() -> None:
    assert [p.message for p in picks({"/map": ("std_msgs/msg/String", GRID)}, {"Map": Map})] == [
        GRID
    ]


def test_a_display_of_any_type_is_offered_for_unsupported_topics() -> None:
    topics = {"/map": (GRID,), "/chatter": ("std_msgs/msg/String",), "/map_updates": (UPDATE,)}
    result = picks(topics, {**DISPLAYS, "Anything": Anything})
    assert [(pick.topic, pick.display) for pick in result if pick.display == "Anything"] == [
        ("/chatter", "Anything"),
        ("/map_updates", "Anything"),
    ]


def test_a_display_of_topics_of_one_name_leaves_the_others_to_those_of_any_type() -> None:
    text = ("std_msgs/msg/String",)
    topics = {"/arm/robot_description": text, "/chatter": text}
    result = picks(topics, {"Description": Description, "Anything": Anything})
    assert [(pick.topic, pick.display, pick.input) for pick in result] == [
        ("/arm/robot_description", "Description", "urdf"),
        ("/chatter", "Anything", "topic"),
    ]


def test_a_pick_adds_the_display_with_its_topic() -> None:
    pick = Pick("/map", "Outline", "source", GRID)
    assert (pick.display, pick.values) == ("Outline", {"source": "/map"})


def test_a_display_of_a_namespace_is_offered_for_its_topic() -> None:
    topics = {"/a/b/update": ("a/msg/Update",), "/odd": ("a/msg/Update",)}
    (pick,) = picks(topics, {"Handles": Handles})
    assert (pick.display, pick.values) == ("Handles", {"of": "/a/b"})


def test_an_unsupported_topic_has_a_reason() -> None:
    assert no_display(("sensor_msgs/msg/Imu",)) == "No display for sensor_msgs/msg/Imu."
    assert no_display(("a/msg/B", "c/msg/D")) == "No display for a/msg/B or c/msg/D."


def test_no_display_is_offered_twice_for_a_topic() -> None:
    displays = display_types()
    specs = [spec for cls in displays.values() for spec in inputs_of(cls).values()]
    types = {type_ for spec in specs for type_ in spec.types if type_ != ANY}
    offered = picks({f"/{type_}": (type_,) for type_ in types}, displays)
    offers = [(pick.topic, pick.display) for pick in offered]
    assert sorted(offers) == sorted(set(offers))
