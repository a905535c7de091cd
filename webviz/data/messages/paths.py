"""Paths to the fields of messages: `twist.linear.x`, `position[0]`, `position[left_wheel]`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import Any

import numpy as np

from webviz.data.messages.classes import attribute
from webviz.data.messages.errors import MessageError
from webviz.data.messages.geometry import Duration, Time
from webviz.data.messages.tree import field_names

MAX_LENGTH = 400
"""Characters of a path."""
MAX_SEARCHED = 10_000
"""Elements of a sequence among which one is found by name."""
MAX_LISTED = 20
"""Elements of a sequence that `numeric_paths` lists."""
MAX_DEPTH = 16
NAMES = ("name", "key", "id", "child_frame_id", "child", "frame_id")
"""Fields that name an element of a sequence, the most telling first."""
_COMPONENTS = ("xyzw", "rgba")
_STEP = re.compile(r"(?:^|\.)([A-Za-z]\w*)|\[([^\[\]]*)\]")


class PathError(MessageError):
    """A path is invalid, or a message has no such field; one sentence."""


class FieldPath:
    """Finds a value in messages.

    `[3]` is an element, `[-1]` the last one. `[text]` is the element with that name: of numbers, by
    the list `name` beside them as in sensor_msgs/JointState; of messages, by one of `NAMES`.

    Args:
        text: fields with dots between them.

    Raises:
        PathError: it is not a path.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self._steps: list[str | int | tuple[str]] = []
        end = 0
        for match in _STEP.finditer(text) if len(text) <= MAX_LENGTH else ():
            if match.start() != end:
                break
            end = match.end()
            name, key = match.groups()
            self._steps.append(name or (int(key) if _is_index(key) else (key,)))
        if not self._steps or end != len(text) or not isinstance(self._steps[0], str):
            raise PathError(
                f"`{text[:80]}` is not the path of a field, such as `pose.position.x`, "
                "`position[0]` or `position[left_wheel]`."
            )

    def __call__(self, message: Any) -> Any:
        """The value in a message.

        Raises:
            PathError: it has no such field or element.
        """
        parent, value = None, message
        for step in self._steps:
            if isinstance(step, str):
                parent, value = value, self._field(value, step)
            else:
                value = self._element(parent, value, step)
        return value

    def number(self, message: Any) -> float:
        """The value as a number: that of times and durations in seconds, 1 for true.

        Raises:
            PathError: it has no such field or element, or that is not a number.
        """
        value = self(message)
        if (number := as_number(value)) is None:
            raise PathError(f"`{self.text}` is not a number. Choose one of its parts.")
        return number

    def _field(self, value: Any, name: str) -> Any:
        names = field_names(value)
        if (own := attribute(name)) in names:
            return getattr(value, own)
        if isinstance(value, np.ndarray) and value.ndim == 1:
            for letters in _COMPONENTS:
                if 0 <= (index := letters.find(name)) < len(value):
                    return value[index]
        known = f"one of {', '.join(names[:20])}" if names else "a path without it"
        raise PathError(f"No field `{name}` for `{self.text}`. Choose {known}.")

    def _element(self, parent: Any, value: Any, key: int | tuple[str]) -> Any:
        if isinstance(value, str) or not hasattr(value, "__len__"):
            raise PathError(f"`{self.text}` asks for an element of what is not an array.")
        index = key if isinstance(key, int) else _index_of(key[0], parent, value)
        if index is None or not -len(value) <= index < len(value):
            what = key if isinstance(key, int) else f"named {key[0]}"
            raise PathError(f"No element {what} for `{self.text}`; there are {len(value)}.")
        return value[index]


def as_number(value: Any) -> float | None:
    """A value as a number, None if it is not one."""
    if isinstance(value, bool | int | float | np.number | np.bool_):
        return float(value)
    return value.ns / 1e9 if isinstance(value, Time | Duration) else None


def numeric_paths(message: Any, most: int) -> list[str]:
    """The paths of the first numbers in a message, with some elements of each sequence."""
    return list(islice(_numbers(None, message, "", MAX_DEPTH), most))


def _numbers(parent: Any, value: Any, path: str, depth: int) -> Iterator[str]:
    if as_number(value) is not None:
        yield path
    elif depth == 0 or isinstance(value, str):
        return
    elif names := field_names(value):
        for name in names:
            inner = f"{path}.{name}" if path else name
            yield from _numbers(value, getattr(value, name), inner, depth - 1)
    elif hasattr(value, "__len__"):
        for key, item in zip(_keys(parent, value), islice(value, MAX_LISTED), strict=False):
            yield from _numbers(None, item, f"{path}[{key}]", depth - 1)


def _keys(parent: Any, value: Sequence[Any]) -> Iterable[str | int]:
    """The names of the elements of a sequence, their numbers if they have none."""
    names = _names_beside(parent, value)
    if len(names) == len(value) and len({*names}) == len(names) and all(map(_is_key, names)):
        return names
    return range(len(value))


def _index_of(name: str, parent: Any, value: Sequence[Any]) -> int | None:
    """The place of the element with a name."""
    for index, each in enumerate(islice(_names_beside(parent, value), MAX_SEARCHED)):
        if each == name:
            return index
    for index, each in enumerate(islice(value, MAX_SEARCHED)):
        own = next((field for field in NAMES if field in field_names(each)), None)
        if own is not None and str(getattr(each, own)) == name:
            return index
    return None


def _names_beside(parent: Any, value: Any) -> Sequence[str]:
    names = getattr(parent, "name", ())
    is_list = isinstance(names, list) and names is not value
    return names if is_list else ()


def _is_key(name: Any) -> bool:
    """Return whether an element can be called by a name."""
    return isinstance(name, str) and bool(re.fullmatch(r"[^\[\]]+", name)) and not _is_index(name)


def _is_index(key: str) -> bool:
    return bool(re.fullmatch(r"-?[0-9]{1,9}", key))
