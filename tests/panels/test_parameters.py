"""The panel Parameters, with a node that answers like rclcpp's, and YAML for `ros2 param load`."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import pytest

from tests.support.panel_facts import show as show_panel
from webviz.api.errors import Error
from webviz.commands import CallService
from webviz.data.messages import encode, interfaces, message_class
from webviz.data.parameters import KINDS
from webviz.engine.state import State
from webviz.page.recorded_ui import RecordedUi
from webviz.panels.parameter_values import flat, to_yaml
from webviz.panels.parameters import MAX_PARAMETERS, Parameters
from webviz.panels.yaml_text import MAX_CHARACTERS, inline, read_yaml, write_yaml
from webviz.sources import Offer, Publisher

VALUE = message_class("rcl_interfaces/msg/ParameterValue")
DESCRIPTOR = message_class("rcl_interfaces/msg/ParameterDescriptor")
RANGE = message_class("rcl_interfaces/msg/FloatingPointRange")
RESULT = message_class("rcl_interfaces/msg/SetParametersResult")
HOSTILE = "<img src=x onerror=alert(1)>\u202e"


class Answer:
    """A response of a service."""

    def __init__(self, **fields: Any) -> None:
        self.__dict__.update(fields)


class ParameterNode:
    """A node with parameters: texts are refused.

    Args:
        values: of its parameters by name, as types and values.
    """

    def __init__(self, **values: tuple[int, Any]) -> None:
        self.values: dict[str, tuple[int, Any]] = dict(values)
        self.requests: list[CallService] = []

    def __call__(self, command: Any, browser: int | None = None) -> None:
        self.requests.append(command)
        encode(interfaces.service(command.type).request, command.request)
        service = command.service.rpartition("/")[2]
        request: Mapping[str, Any] = command.request
        if service == "list_parameters":
            response = Answer(result=Answer(names=list(self.values)))
        elif service == "describe_parameters":
            limits = [RANGE(from_value=0.0, to_value=2.0)]
            fields = {"description": f"About {HOSTILE}", "floating_point_range": limits}
            response = Answer(descriptors=[DESCRIPTOR(**fields) for _ in request["names"]])
        elif service == "get_parameters":
            pairs = [self.values[name] for name in request["names"]]
            values = [
                VALUE(type=kind, **({KINDS[kind][1]: value} if kind else {}))
                for kind, value in pairs
            ]
            response = Answer(values=values)
        else:
            results = []
            for each in request["parameters"]:
                kind = each["value"]["type"]
                is_text = kind == 4
                results.append(RESULT(successful=not is_text, reason="No texts." * is_text))
                if not is_text:
                    self.values[each["name"]] = kind, each["value"][KINDS[kind][1]]
            response = Answer(results=results)
        command.answered(response)


def open_panel(
    **values: tuple[int, Any],
) -> tuple[Parameters, ParameterNode, Callable[[], dict[str, Any]]]:
    """Open the panel on a node."""
    node, panel, ui = ParameterNode(**values), Parameters(node="/base"), RecordedUi()
    panel.build(ui, node)
    offer = Offer((Publisher("/base", "", "reliable", "volatile"),))

    def values_of() -> dict[str, Any]:
        show_panel(panel, State(offers={"/parameter_events": offer}))
        return dict(ui.widgets["1"].values["values"])

    return panel, node, values_of


def test_parameters_are_shown_set_refused_and_taken_back() -> None:
    panel, node, values = open_panel(speed=(3, 0.5), name=(4, "x"), unset=(0, None))
    rows = {row["name"]: row for row in values()["rows"]}
    assert (rows["speed"]["text"], rows["speed"]["kind"]) == ("0.5", "double")
    assert rows["speed"]["range"] == "0 to 2"
    assert "\u202e" not in rows["speed"]["about"]
    assert rows["unset"]["locked"]
    panel.use({"set": ["speed", "1"]}, 1)
    assert node.values["speed"] == (3, 1.0)
    panel.use({"set": ["name", "new"]}, 1)
    assert values()["outcome"] == "The node refused name: No texts."
    assert [row["refused"] for row in values()["rows"]] == ["No texts.", "", ""]
    assert values()["undo"] == 1
    panel.use({"undo": True}, 1)
    assert node.values["speed"] == (3, 0.5)
    with pytest.raises(Error, match="nothing to undo"):
        panel.use({"undo": True}, 1)


def test_a_file_saved_by_the_panel_sets_the_parameters_it_names() -> None:
    panel, node, values = open_panel(
        **{"a.b": (2, 1), "a.c": (8, [1.0, math.inf]), "on": (1, True)}
    )
    yaml = values()["yaml"]
    assert yaml == (
        '/base:\n  ros__parameters:\n    a:\n      b: 1\n      c: [1.0, .inf]\n    "on": true\n'
    )
    panel.use({"load": yaml.replace("b: 1", "b: 7") + "    other: 1\n"}, 1)
    assert node.values["a.b"] == (2, 7)
    assert values()["outcome"] == "3 parameters set. The node does not have other."
    assert flat(read_yaml(yaml)["/base"]["ros__parameters"]) == {
        "a.b": 1,
        "a.c": [1.0, math.inf],
        "on": True,
    }
    with pytest.raises(Error, match="The file has no `/base: ros__parameters:`"):
        panel.use({"load": "/other: {ros__parameters: {on: true}}"}, 1)
    assert '"a": 1' not in to_yaml("/n", {"a": {"kind": 2, "value": 1}})
    both = {name: {"kind": 2, "value": 1} for name in ("a", "a.b")}
    assert flat(read_yaml(to_yaml("/n", both))["/n"]["ros__parameters"]) == {"a": 1, "a.b": 1}


@pytest.mark.parametrize(
    ("kind", "text", "reason"),
    [
        (1, "5", "Expected bool, such as true; got 5."),
        (2, "1.5", "Expected int"),
        (2, str(2**63), "Expected int"),
        (3, "fast", "got fast"),
        (3, "1" + "0" * 400, "Expected double"),
        (3, "1" * 5000, ""),
        (7, "[1, x]", "got x"),
        (9, "a", "Expected string[]"),
        (3, "[" * 2000, ""),
        (3, "&a [*a]", "Aliases"),
        (3, "{a: b: c}", "not valid YAML"),
    ],
)
def test_a_value_that_does_not_fit_is_refused(
    kind: int,
    text: str,
    reason: str,
) -> None:
    values = {1: True, 2: 1, 3: 1.0, 7: [1], 9: ["a"]}
    panel, node, show = open_panel(x=(kind, values[kind]))
    show()
    with pytest.raises(Error) as error:
        panel.use({"set": ["x", text]}, 1)
    assert reason in str(error.value)
    assert node.values == {"x": (kind, values[kind])}


def test_many_and_long_parameters_are_bounded() -> None:
    _, _, values = open_panel(**{f"p{i}": (4, "x" * 10_000) for i in range(3 * MAX_PARAMETERS)})
    result = values()
    assert len(str(result)) < 400_000
    assert result["rows"][0]["locked"]
    assert "more." in result["note"]


def test_only_named_nodes_may_be_changed() -> None:
    assert Parameters().uses == ()
    assert Parameters(node="/base").uses == ()
    assert Parameters(editable=["/base", "no"]).uses == ("/base/set_parameters",)


@pytest.mark.parametrize(
    "value",
    [1.0, 1e308, 1e-7, -0.0, "yes", "1e5", "a: b", "\x07\n", "", [1.5, 2.0], ["a", "ü"], True, 10],
)
def test_a_value_is_read_as_it_was_written(value: Any) -> None:
    assert read_yaml(write_yaml({"a b": {"on": value}})) == {"a b": {"on": value}}
    assert type(read_yaml(inline(value))) is type(value)


def test_a_long_text_is_refused() -> None:
    with pytest.raises(Error, match="the limit is"):
        read_yaml("x" * (MAX_CHARACTERS + 1))
