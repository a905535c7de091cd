"""Names of the values of fields, which the constants of their types give."""

from __future__ import annotations

from typing import Any

import pytest

from webviz.data.messages import message_class, register, to_tree
from webviz.data.messages.message_paths import MessagePath
from webviz.data.messages.typestore import DefinedTypes
from webviz.data.messages.value_names import NO_NAMES, named, value_names


def names(type_name: str, field: str) -> dict[int, str]:
    return dict(value_names(type_name).get(field, {}))


@pytest.mark.parametrize(
    ("type_name", "field", "value", "name"),
    [
        # Constants begin with the name of their field, or with the end of it ...
        ("sensor_msgs/msg/BatteryState", "power_supply_status", 2, "DISCHARGING"),
        ("sensor_msgs/msg/BatteryState", "power_supply_health", 3, "DEAD"),
        ("sensor_msgs/msg/NavSatFix", "position_covariance_type", 3, "KNOWN"),
        ("sensor_msgs/msg/NavSatStatus", "status", -1, "NO_FIX"),
        ("action_msgs/msg/GoalStatus", "status", 6, "ABORTED"),
        # ... or there is one field of their type,
        ("sensor_msgs/msg/Range", "radiation_type", 1, "INFRARED"),
        ("tf2_msgs/msg/TF2Error", "error", 3, "EXTRAPOLATION_ERROR"),
        # which may be of uint8 beside constants of byte.
        ("rcl_interfaces/msg/Log", "level", 40, "ERROR"),
    ],
)
def test_values_have_the_names_of_constants(
    type_name: str, field: str, value: int, name: str
) -> None:
    assert names(type_name, field)[value] == name


@pytest.mark.parametrize(
    ("type_name", "field"),
    [
        ("visualization_msgs/msg/Marker", "type"),  # its constants may be of `action`
        ("visualization_msgs/msg/Marker", "action"),
        ("rcl_interfaces/msg/ParameterType", "structure_needs_at_least_one_member"),
        ("rcl_interfaces/msg/ParameterValue", "type"),  # its constants are in another type
        ("geometry_msgs/msg/Vector3", "x"),
        ("nobody_msgs/msg/Unknown", "x"),
    ],
)
def test_fields_without_constants_of_their_own_have_no_names(type_name: str, field: str) -> None:
    assert names(type_name, field) == {}


def test_a_value_of_several_constants_has_no_name() -> None:
    solid = names("shape_msgs/msg/SolidPrimitive", "type")
    assert 1 not in solid  # BOX, and the index of a dimension
    assert solid[5] == "PRISM"


def test_a_limit_does_not_name_a_value() -> None:
    types = DefinedTypes("a/msg/B", "uint8 MOST=10\nuint8 count\n", ())
    assert value_names("a/msg/B", types) == {}


def test_a_definition_names_values_of_its_own_messages() -> None:
    types = DefinedTypes("a/msg/B", "int32 MODE_IDLE=0\nint32 MODE_RUN=1\nint32 mode\n", ())
    message = message_class("a/msg/B", types)(mode=1)
    assert to_tree(message) == {"fields": {"mode": "RUN (1)"}}


def test_names_follow_a_definition_that_is_replaced() -> None:
    name = "value_names_test/msg/Mode"
    register(name, "int32 MODE_IDLE=0\nint32 MODE_RUN=1\nint32 mode\n")
    assert names(name, "mode") == {0: "IDLE", 1: "RUN"}
    register(name, "int32 MODE_RUN=0\nint32 MODE_IDLE=1\nint32 mode\n")
    assert names(name, "mode") == {0: "RUN", 1: "IDLE"}


def test_names_are_of_numbers_alone() -> None:
    assert named(1, {1: "RUN"}) == "RUN (1)"
    assert named(2, {1: "RUN"}) == ""
    assert named(True, {1: "RUN"}) == ""
    assert named(1.0, {1: "RUN"}) == ""


def diagnostics(level: int) -> Any:
    status = message_class("diagnostic_msgs/msg/DiagnosticStatus")(level=level)
    return message_class("diagnostic_msgs/msg/DiagnosticArray")(status=[status])


def test_message_paths_know_the_names_of_their_values() -> None:
    message = diagnostics(1)
    assert MessagePath("/d.status[0].level").value_names(message)[1] == "WARN"
    assert MessagePath("/d.status[:]{level==1}.level").value_names(message)[1] == "WARN"
    assert MessagePath("/d.status[0].level.@abs").value_names(message) == NO_NAMES
    assert MessagePath("/d.status[0].name").value_names(message) == NO_NAMES
    assert MessagePath("/d").value_names(message) == NO_NAMES
