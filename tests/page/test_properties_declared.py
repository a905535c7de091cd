"""The declarations of properties, as the page receives them."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec
import pytest

from webviz.api.declared import Color, Prop, Topic
from webviz.api.display import Display, Input
from webviz.api.properties import Property, properties_of
from webviz.engine.forms import MAX_TEXT, form, leaves, sendable, values_of


class Nested(msgspec.Struct, frozen=True):
    value: bool = True
    shape: Literal["Sphere", "Box"] = "Sphere"
    edge: Annotated[float, Prop(gt=0, unit="m", when=("shape", "Box"))] = 1.0


class Sample(Display):
    topic: Annotated[Topic, Input("sensor_msgs/msg/Imu")] = Topic("/imu")
    color_by: Literal["Intensity", "Axis", "Flat"] = "Intensity"
    use_rainbow: Annotated[bool, Prop(when=("color_by", "Intensity"))] = True
    invert_rainbow: Annotated[bool, Prop(when=("use_rainbow", True), help="Turn it round.")] = False
    size: Annotated[float, Prop(gt=0, unit="m", rviz="Size (m)")] = 0.1
    count: Annotated[int, Prop(ge=0, le=9)] = 1
    frame: Annotated[str, Prop(widget="frame")] = "map"
    color: Color = (1, 2, 3)
    flat: tuple[float, float] = (0.0, 1.0)
    covariance: tuple[float, float, float, float] = (0.0, 1.0, 2.0, 3.0)
    prefixes: list[str] = msgspec.field(default_factory=list)
    shown: dict[str, bool] = msgspec.field(default_factory=dict)
    marker: Nested = Nested()


PROPERTIES = {each.path: each for each in leaves(properties_of(Sample))}


def declared() -> dict[str, Any]:
    return {each["path"]: each for each in msgspec.json.decode(form(Sample))}


def test_the_name_comes_first_and_the_rest_as_declared() -> None:
    assert list(declared())[:4] == ["name", "enabled", "topic", "color_by"]


def test_labels_are_rviz_names_with_the_unit_beside_them() -> None:
    assert PROPERTIES["size"].label == "Size (m)"
    assert PROPERTIES["marker.value"].label == "Marker"
    declarations = declared()
    assert declarations["invert_rainbow"]["label"] == "Invert Rainbow"
    assert (declarations["size"]["label"], declarations["size"]["unit"]) == ("Size", "m")
    assert declarations["marker"]["children"][2]["label"] == "Edge"


def test_each_kind_is_named() -> None:
    kinds = {path: each["kind"] for path, each in declared().items()}
    assert kinds == {
        "name": "text",
        "enabled": "bool",
        "topic": "topic",
        "color_by": "choice",
        "use_rainbow": "bool",
        "invert_rainbow": "bool",
        "size": "float",
        "count": "int",
        "frame": "frame",
        "color": "color",
        "flat": "vector",
        "covariance": "list",
        "prefixes": "list",
        "shown": "dict",
        "marker": "group",
    }


def test_choices_bounds_help_defaults_and_types_are_told() -> None:
    declarations = declared()
    assert declarations["color_by"]["choices"] == ["Intensity", "Axis", "Flat"]
    assert declarations["size"]["above"] == 0
    assert (declarations["count"]["low"], declarations["count"]["high"]) == (0, 9)
    assert declarations["invert_rainbow"]["help"] == "Turn it round."
    assert declarations["topic"]["type"] == "sensor_msgs/msg/Imu"
    assert declarations["topic"]["children"][0]["default"] == "/imu"
    assert (declarations["prefixes"]["items"], declarations["shown"]["items"]) == ("text", "json")


def test_conditions_are_told_with_those_of_what_they_name() -> None:
    assert declared()["invert_rainbow"]["when"] == [
        ["use_rainbow", [True]],
        ["color_by", ["Intensity"]],
    ]


@pytest.mark.parametrize(
    ("path", "display", "applies"),
    [
        ("invert_rainbow", Sample(), True),
        ("invert_rainbow", Sample(use_rainbow=False), False),
        ("invert_rainbow", Sample(color_by="Flat"), False),
        ("marker.edge", Sample(), False),
        ("marker.edge", Sample(marker=Nested(shape="Box")), True),
    ],
)
def test_a_property_applies_only_if_the_one_it_depends_on_does(
    path: str, display: Sample, applies: bool
) -> None:
    property_: Property = PROPERTIES[path]
    assert property_.applies(display) is applies


def test_every_value_has_its_path() -> None:
    values = values_of(Sample(shown={"a": True}), without=("name", "enabled"))
    assert values["shown"] == {"a": True}
    assert values["marker.shape"] == "Sphere"
    assert values["topic.depth"] == 0
    assert "name" not in values


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("half \ud800", "half ?"),
        ("x" * (MAX_TEXT + 9), "x" * (MAX_TEXT - 1) + "…"),
        ({"\ud800": [Nested()]}, {"?": [{"value": True, "shape": "Sphere", "edge": 1.0}]}),
        (2**70, 2**70),
    ],
)
def test_whatever_a_value_is_can_be_sent(value: Any, expected: Any) -> None:
    assert sendable(value) == expected
    msgspec.json.encode(sendable(value))
