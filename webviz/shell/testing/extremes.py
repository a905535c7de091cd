"""Extreme values in every field of a message, and what a display must not do with them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields as dataclass_fields
from typing import Any

import numpy as np

from webviz.api.display import inputs, inputs_of
from webviz.api.nodes import Node, has_content
from webviz.data.messages import encode
from webviz.data.messages.classes import DTYPES
from webviz.data.messages.typestore import MessageField, fields
from webviz.engine.pipeline.runner import NOTHING_TO_DRAW
from webviz.shell.testing.bench import DisplayBench
from webviz.shell.testing.messages import header

Values = dict[str, Any]
Case = tuple[tuple[str | int, ...], Any]
"""A place in a message, and the value that is put there."""

FARTHEST = 4e9
"""Metres, of what is drawn at most: a graphics card's float32 cannot square much more."""

LAST = "\x7f"
"""Stands for bytes that are not UTF-8."""


def extremes(field: MessageField) -> list[Any]:
    """Values for a field that is not a message itself."""
    if field.base in ("string", "wstring"):
        texts = ["", "/", LAST, "x" * 70_000, "no such frame", "\N{SNOWMAN}\n\t%s{}<b>"]
        return texts if field.size is None else [[], *([text] for text in texts), texts]
    dtype = DTYPES[field.base]
    if dtype.kind == "b":
        values = [False, True]
    elif dtype.kind == "f":
        limits = np.finfo(dtype)
        large = [float(limits.max), -float(limits.max), float(limits.smallest_subnormal)]
        values = [float("nan"), float("inf"), -float("inf"), *large, 1e12, -1.0, 0.0]
    else:
        limits = np.iinfo(dtype)
        values = sorted({int(limits.min), int(limits.max), 0, 1})
    if field.size is None:
        return values
    counts = [count for count in (0, 1, 5, 1000) if not field.most or count <= field.most]
    return [[value] * (field.size or count) for value in values for count in counts]


def cases(type_name: str, values: Values, path: tuple[str | int, ...] = ()) -> Iterator[Case]:
    """Yield an extreme value for each field of a message, those of its parts included."""
    for field in fields(type_name):
        here, value = (*path, field.name), values.get(field.name)
        if not field.is_message:
            yield from ((here, extreme) for extreme in extremes(field))
        elif field.size is None:
            yield from cases(field.base, value or {}, here)
        else:
            if not field.size:  # any number fits
                yield here, []
            for index, element in enumerate(value or ()):
                yield from cases(field.base, element, (*here, index))


def changed(values: Values, case: Case) -> Values:
    """Return the values with an extreme one in its place; a place that is gone stays gone.

    Only the parts on the way there are copied.
    """
    (*path, last), value = case
    part: Any = (found := dict(values))
    for key in path:
        if isinstance(key, int) and key >= len(part):
            return found
        below = part[key] if isinstance(key, int) else part.get(key, {})
        part[key] = dict(below) if isinstance(below, Mapping) else list(below)
        part = part[key]
    part[last] = value
    return found


def send(at: DisplayBench, name: str, values: Mapping[str, Any]) -> None:
    """Publish a message for an input and let the display draw it, slow work included."""
    type_name = inputs_of(type(at.display))[name].type
    if fields(type_name)[0].base == "std_msgs/msg/Header":
        values = {"header": header("sensor", at.now_ns), **values}
    cdr = encode(type_name, values).replace(LAST.encode(), b"\xff")
    topic = next(topic.name for input, _, topic in inputs(at.display) if input == name)
    at.send_bytes(type_name, cdr, topic)
    at.turn()
    at.settle()


def faults(at: DisplayBench) -> list[str]:
    """Return violations of what must hold however odd a message is."""
    found, nodes = [], at.nodes()
    for key, node in nodes.items():
        found += [f"{key}.{name} is not finite" for name in infinite(node)]
    for key, pose in at.poses().items():
        if not np.isfinite([*pose.position, *pose.wxyz]).all():
            found.append(f"the pose of {key} is not finite")
    box = None if found else at.scene.bounds("")
    if box is not None and not np.abs([box.low, box.high]).max() < FARTHEST:
        found.append(f"it reaches to {box}")
    said = at.statuses()
    silent = all(level == "OK" or text == NOTHING_TO_DRAW.text for level, text in said.values())
    is_blank = not type(at.display).reports_only and not any(map(has_content, nodes.values()))
    if is_blank and silent:
        found.append(f"nothing is drawn, and the only status is: {said}")
    return found


def infinite(node: Node) -> Iterator[str]:
    """Name the fields of a node that have values which are not finite."""
    for field in dataclass_fields(node):
        value = getattr(node, field.name)
        if field.name == "ids":
            continue  # names, or numbers of items
        if isinstance(value, float | np.ndarray) and not np.isfinite(value).all():
            yield field.name
