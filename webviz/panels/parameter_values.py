"""Values of parameters, as text and as YAML that `ros2 param load` reads."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Mapping
from typing import Any

from webviz.api.errors import Error
from webviz.data.parameters import BYTES, KINDS, Value
from webviz.panels.yaml_text import read_yaml, write_yaml

INT64 = 2**63


def parse(text: str, kind: int) -> Value:
    """Return a value from entered text.

    Raises:
        Error: it does not fit the type.
    """
    return text if kind == 4 else fitting(read_yaml(str(text)), kind)


def fitting(value: Any, kind: int) -> Value:
    """Return a value of YAML as one of this type.

    Raises:
        Error: it does not fit the type.
    """
    name = KINDS[kind][0]
    if kind >= BYTES:
        if isinstance(value, list):
            return [fitting(each, 2 if kind == BYTES else kind - 5) for each in value]
    elif kind == 1 and isinstance(value, bool):
        return value
    elif kind == 2 and isinstance(value, int) and not isinstance(value, bool):
        if -INT64 <= value < INT64:
            return value
    elif kind == 3 and isinstance(value, int | float) and not isinstance(value, bool):
        with contextlib.suppress(OverflowError):
            return float(value)
    elif kind == 4 and isinstance(value, str):
        return value
    raise Error(f"Expected {name}, such as {EXAMPLES[name]}; got {str(value)[:80]}.")


EXAMPLES = {
    "bool": "true",
    "int": "5",
    "double": "0.5",
    "string": "'text'",
    "byte[]": "[1, 2]",
    "bool[]": "[true, false]",
    "int[]": "[1, 2]",
    "double[]": "[0.5, 1.0]",
    "string[]": "[a, b]",
}


def of_node(document: Any, node: str) -> Mapping[str, Any]:
    """Return the parameters of a node in a file as `ros2 param dump` writes it.

    Raises:
        Error: the file is not about this node.
    """
    if isinstance(document, Mapping):
        for name in (node, node.removeprefix("/"), node.rpartition("/")[2], "/**"):
            inner = document.get(name)
            if isinstance(inner, Mapping) and isinstance(inner.get("ros__parameters"), Mapping):
                return inner["ros__parameters"]
    raise Error(f"The file has no `{node}: ros__parameters:`. Choose another file or node.")


def flat(values: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    """Nested parameters by their names with dots."""
    flattened: dict[str, Any] = {}
    for key, value in values.items():
        name = f"{before}{key}"
        flattened |= flat(value, f"{name}.") if isinstance(value, Mapping) else {name: value}
    return flattened


def to_yaml(node: str, rows: Mapping[str, Mapping[str, Any]]) -> str:
    """Parameters as `ros2 param load` takes them; bytes, which YAML does not have, are left out."""
    values = {
        name: row["value"]
        for name, row in rows.items()
        if row["value"] is not None and row["kind"] != BYTES
    }
    return write_yaml({node: {"ros__parameters": _nested(values)}})


def _nested(values: Mapping[str, Any]) -> dict[str, Any]:
    """Names with dots as mappings, unless one is a parameter and a group of others."""
    names = set(values)
    groups = {name.rpartition(".")[0] for name in names} - {""}
    if any(prefix in names for group in groups for prefix in _prefixes(group)):
        return dict(values)
    nested: dict[str, Any] = {}
    for name, value in values.items():
        *inner, last = name.split(".")
        place = nested
        for each in inner:
            place = place.setdefault(each, {})
        place[last] = value
    return nested


def _prefixes(group: str) -> Iterable[str]:
    parts = group.split(".")
    return (".".join(parts[: i + 1]) for i in range(len(parts)))
