"""Parameters of nodes: the types of their values, as in rcl_interfaces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

KINDS = {
    1: ("bool", "bool_value"),
    2: ("int", "integer_value"),
    3: ("double", "double_value"),
    4: ("string", "string_value"),
    5: ("byte[]", "byte_array_value"),
    6: ("bool[]", "bool_array_value"),
    7: ("int[]", "integer_array_value"),
    8: ("double[]", "double_array_value"),
    9: ("string[]", "string_array_value"),
}
"""Types of rcl_interfaces/msg/ParameterType: their names, and where the value is."""
BYTES = 5

Value = bool | int | float | str | Sequence[Any]


def plain(value: Any, kind: int) -> Value | None:
    """Return the value in a rcl_interfaces/msg/ParameterValue, None if it is not set."""
    if kind not in KINDS:
        return None
    content = getattr(value, KINDS[kind][1])
    if hasattr(content, "tolist"):
        return content.tolist()
    return list(content) if kind >= BYTES else content
