"""Names of the values of fields, such as DISCHARGING of a battery's `power_supply_status` 2.

Definitions do not say which constants are values of which field. Two customs of ROS's interfaces
do: constants begin with the name of their field or with the end of it (`POWER_SUPPLY_STATUS_FULL`,
`COVARIANCE_TYPE_KNOWN` of `position_covariance_type`), or a message has one field of their type.
Where neither holds, as with type and action of a marker, a value has no name here.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from webviz.data.messages.classes import types_of
from webviz.data.messages.errors import MessageError
from webviz.data.messages.typestore import (
    KNOWN,
    MessageTypes,
    fields,
    per_definitions,
    typed_constants,
)

ValueNames = Mapping[int, str]

NO_NAMES: ValueNames = {}
NO_FIELD = "structure_needs_at_least_one_member"
"""Field of a message that has none, as ROS generates it."""
FEWEST = 2
"""Constants that are values of a field; a single one is rather a limit."""

_SAME = {"byte": "uint8", "octet": "uint8", "char": "uint8"}
"""Types of constants that stand beside fields of uint8, as in rcl_interfaces/msg/Log."""
_WHOLE = {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}


def named(value: Any, names: ValueNames) -> str:
    """Return a value with its name, "DISCHARGING (2)", and "" if it has none."""
    name = names.get(value) if isinstance(value, int) and not isinstance(value, bool) else None
    return f"{name} ({value})" if name else ""


def names_in(message: object) -> Mapping[str, ValueNames]:
    """Return the names of values of a decoded message by field."""
    type_name = getattr(type(message), "_type_name", "")
    return value_names(type_name, types_of(message)) if type_name else {}


def names_at(message: object, path: Sequence[str]) -> ValueNames:
    """Return the names of values of a field inside a decoded message.

    Args:
        message: whose field it is.
        path: names of the fields that lead to it, from the outermost.
    """
    type_name, types = getattr(type(message), "_type_name", ""), types_of(message)
    if not type_name:
        return NO_NAMES
    try:
        for name in path[:-1]:
            type_name = next(f.base for f in fields(type_name, types) if f.name == name)
        return value_names(type_name, types).get(path[-1], NO_NAMES) if path else NO_NAMES
    except (MessageError, StopIteration):
        return NO_NAMES


@per_definitions
def value_names(type_name: str, types: MessageTypes = KNOWN) -> Mapping[str, ValueNames]:
    """Return the names of values of a type's fields by field; of those alone that have names.

    Args:
        type_name: such as "sensor_msgs/msg/BatteryState".
        types: that define it.
    """
    try:
        single = [field for field in fields(type_name, types) if field.size is None]
        bases = {each.name: _SAME.get(each.base, each.base) for each in single}
        whole = {name: b for name, b in bases.items() if b in _WHOLE and name != NO_FIELD}
        constants = [
            (name, _SAME.get(base, base), value)
            for name, base, value in typed_constants(type_name, types)
            if type(value) is int
        ]
    except MessageError:
        return {}
    names: dict[str, ValueNames] = {}
    for field, base in sorted(whole.items(), key=lambda item: -len(item[0])):
        mine = {n: v for n, b, v in constants if b == base and _prefix(n, field)}
        if len(mine) >= FEWEST:
            names[field] = _by_value({n[len(_prefix(n, field)) :]: v for n, v in mine.items()})
            constants = [each for each in constants if each[0] not in mine]
    for base, count in Counter(b for f, b in whole.items() if f not in names).items():
        rest = {n: v for n, b, v in constants if b == base}
        if count == 1 and len(rest) >= FEWEST:
            field = next(f for f, b in whole.items() if b == base and f not in names)
            names[field] = _by_value(rest)
    return names


def _prefix(constant: str, field: str) -> str:
    """Return the beginning of a constant that names a field, "" if it does not."""
    words = field.upper().split("_")
    for place in range(len(words)):
        prefix = "_".join(words[place:]) + "_"
        if constant.startswith(prefix) and len(constant) > len(prefix):
            return prefix
    return ""


def _by_value(constants: Mapping[str, int]) -> ValueNames:
    """Return the names by value; a value that several constants have is ambiguous and has none."""
    counts = Counter(constants.values())
    return {value: name for name, value in constants.items() if counts[value] == 1}
