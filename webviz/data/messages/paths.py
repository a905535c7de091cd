"""Paths to the fields of messages: `twist.linear.x`, `position[0]`, `status[:]{level>=1}.name`.

The syntax is that of the message paths of Foxglove and Lichtblick, with elements by their names
added; `displays/docs/page/message_paths.md` describes it.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

import msgspec
import numpy as np

from webviz.data.messages.classes import attribute
from webviz.data.messages.errors import MessageError
from webviz.data.messages.geometry import Duration, Time
from webviz.data.messages.tree import field_names
from webviz.data.words import counted

MAX_LENGTH = 400
"""Characters of a path."""
MAX_SEARCHED = 10_000
"""Elements of a sequence among which one is found by name or by a filter."""
MAX_FOUND = 1000
"""Values that slices and filters find."""
MAX_LISTED = 20
"""Elements of a sequence that `numeric_paths` lists."""
MAX_DEPTH = 16
NAMES = ("name", "key", "id", "child_frame_id", "child", "frame_id")
"""Fields that name an element of a sequence, the most telling first."""
FILTERS: Mapping[str, Callable[[Any, Any], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<=": operator.le,
    ">=": operator.ge,
    "<": operator.lt,
    ">": operator.gt,
}
"""Comparisons of filters."""
_COMPONENTS = ("xyzw", "rgba")
_FIELD = re.compile(r"(?:\A|\.)([A-Za-z]\w*)")
_KEY = re.compile(r"\[([^\[\]]*)\]")
_SLICE = re.compile(r"(-?[0-9]{1,9})?:(-?[0-9]{1,9})?")
_FILTER = re.compile(
    r"""\{\s*([A-Za-z][\w.\[\]-]*)\s*([=!<>]=|<|>)\s*("[^"]*"|'[^']*'|[\w.+-]+)\s*\}"""
)


class PathError(MessageError):
    """A path is invalid, or a message has no such field; one sentence."""


class NothingMatches(PathError):
    """No element of a message matches a filter or slice, which may be different in the next."""


class _Slice(msgspec.Struct, frozen=True):
    """Elements from the first to the last, both included."""

    first: int
    last: int


class _Filter(msgspec.Struct, frozen=True):
    """A condition of elements."""

    path: FieldPath
    compare: Callable[[Any, Any], bool]
    limit: bool | float | str

    def matches(self, value: Any) -> bool:
        """Return whether a value meets it; one without the field does not."""
        try:
            own_value = self.path(value)
        except PathError:
            return False
        if isinstance(self.limit, str):
            return isinstance(own_value, str) and bool(self.compare(own_value, self.limit))
        number = as_number(own_value)
        return number is not None and bool(self.compare(number, self.limit))


_Step = str | int | tuple[str] | _Slice | _Filter
_Pair = tuple[Any, Any]
"""A value, behind the value that has it."""


class FieldPath:
    """Finds values in messages.

    `[3]` is an element, `[-1]` the last one. `[text]` is the element with that name: of numbers, by
    the list `name` beside them as in sensor_msgs/JointState; of messages, by one of `NAMES`.
    `[1:3]` are the elements 1 to 3, `[:]` all; `{level>=1}` keeps those whose field compares so.

    Args:
        text: fields with dots between them.

    Raises:
        PathError: it is not a path.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self._steps = tuple(_steps(text)) if len(text) <= MAX_LENGTH else ()
        if not self._steps:
            raise PathError(
                f"`{text[:80]}` is not the path of a field, such as `pose.position.x`, "
                "`position[0]` or `position[left_wheel]`."
            )
        self.finds_many = any(isinstance(step, _Slice | _Filter) for step in self._steps)
        """True if messages may have several values, or none: slices and filters choose them."""
        self.names = tuple(step for step in self._steps if isinstance(step, str))
        """Names of the fields, from the outermost."""

    def __call__(self, message: Any) -> Any:
        """Return the value in a message; the list of them if the path has a slice or a filter.

        Raises:
            PathError: it has no such field or element.
        """
        values = self.values(message)
        return values if self.finds_many else values[0]

    def values(self, message: Any) -> list[Any]:
        """Return the values in a message, at most `MAX_FOUND`.

        Raises:
            PathError: it has no such field or element.
        """
        pairs: list[_Pair] = [(None, message)]
        for step in self._steps:
            pairs = list(islice(self._step_pairs(pairs, step), MAX_FOUND))
        return [value for _, value in pairs]

    def one(self, message: Any) -> Any:
        """Return the only value in a message.

        Raises:
            NothingMatches: a filter or slice finds none.
            PathError: it has no such field or element, or several match.
        """
        values = self.values(message)
        if not values:
            raise NothingMatches(f"Nothing in the newest message matches `{self.text}`.")
        if len(values) > 1:
            amount = counted(len(values), "value")
            raise PathError(f"{amount} match `{self.text}`. Choose one with [0] or a filter.")
        return values[0]

    def number(self, message: Any) -> float:
        """Return the only value as a number: that of times and durations in seconds, 1 for true.

        Raises:
            PathError: as `one`, or it is not a number.
        """
        return required_number(self.one(message), self.text)

    def _step_pairs(self, pairs: Iterable[_Pair], step: _Step) -> Iterator[_Pair]:
        """Yield the values a step leads to from those found so far."""
        for parent, value in pairs:
            if isinstance(step, str):
                yield value, self._field(value, step)
            elif isinstance(step, _Slice):
                yield from ((None, each) for each in self._elements(value, step))
            elif isinstance(step, _Filter):
                elements = islice(value, MAX_SEARCHED) if _is_sequence(value) else (value,)
                yield from ((None, each) for each in elements if step.matches(each))
            else:
                yield None, self._element(parent, value, step)

    def _field(self, value: Any, name: str) -> Any:
        names = field_names(value)
        if (own := attribute(name)) in names:
            return getattr(value, own)
        if isinstance(value, np.ndarray) and value.ndim == 1:
            for letters in _COMPONENTS:
                if 0 <= (index := letters.find(name)) < len(value):
                    return value[index]
        alternatives = f"one of {', '.join(names[:20])}" if names else "a path without it"
        raise PathError(f"No field `{name}` for `{self.text}`. Choose {alternatives}.")

    def _element(self, parent: Any, value: Any, key: int | tuple[str]) -> Any:
        self._check_array(value)
        index = key if isinstance(key, int) else _index_of(key[0], parent, value)
        if index is None or not -len(value) <= index < len(value):
            what = key if isinstance(key, int) else f"named {key[0]}"
            raise PathError(f"No element {what} for `{self.text}`; there are {len(value)}.")
        return value[index]

    def _elements(self, value: Any, bounds: _Slice) -> Iterator[Any]:
        self._check_array(value)
        first, last = (
            each + len(value) if each < 0 else each for each in (bounds.first, bounds.last)
        )
        return (value[index] for index in range(max(0, first), min(last + 1, len(value))))

    def _check_array(self, value: Any) -> None:
        if not _is_sequence(value):
            raise PathError(f"`{self.text}` indexes a value that is not an array.")


def _steps(text: str) -> Iterator[_Step]:
    """Yield the steps of a path; the last is followed by nothing, else none at all is returned."""
    steps: list[_Step] = []
    at = 0
    while at < len(text):
        step: _Step
        if match := _FIELD.match(text, at):
            step = match[1]
        elif (match := _KEY.match(text, at)) and steps:
            step = _key(match[1])
        elif match := _FILTER.match(text, at):
            path, compare, limit = match.groups()
            if (literal := _literal(limit)) is None or (at == 0 and match.end() == len(text)):
                return
            step = _Filter(FieldPath(path), FILTERS[compare], literal)
        else:
            return
        steps.append(step)
        at = match.end()
    yield from steps


def _key(text: str) -> int | tuple[str] | _Slice:
    if _is_index(text):
        return int(text)
    if match := _SLICE.fullmatch(text):
        return _Slice(int(match[1] or 0), int(match[2] or -1))
    return (text,)


def _literal(text: str) -> bool | float | str | None:
    """Return the value that a filter compares with; None if it is none."""
    if text[0] in "\"'":
        return text[1:-1]
    if text in ("true", "false"):
        return text == "true"
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def as_number(value: Any) -> float | None:
    """Return a value as a number, None if it is not one."""
    if isinstance(value, bool | int | float | np.number | np.bool_):
        return float(value)
    return value.ns / 1e9 if isinstance(value, Time | Duration) else None


def required_number(value: Any, path: str) -> float:
    """Return the value of a path as a number; raises PathError if it is not one."""
    if (number := as_number(value)) is None:
        raise PathError(f"`{path}` is not a number. Choose one of its parts.")
    return number


def numeric_paths(message: Any, most: int) -> list[str]:
    """Return the paths of the first numbers in a message, with some elements of each sequence."""
    return list(islice(_leaves(None, message, "", MAX_DEPTH, with_texts=False), most))


def leaf_paths(message: Any, most: int) -> list[str]:
    """Return the paths of the first numbers and texts in a message, as `numeric_paths`."""
    return list(islice(_leaves(None, message, "", MAX_DEPTH, with_texts=True), most))


def _leaves(parent: Any, value: Any, path: str, depth: int, *, with_texts: bool) -> Iterator[str]:
    if isinstance(value, str):
        if with_texts:
            yield path
    elif as_number(value) is not None:
        yield path
    elif depth == 0:
        return
    elif names := field_names(value):
        for name in names:
            inner = f"{path}.{name}" if path else name
            yield from _leaves(value, getattr(value, name), inner, depth - 1, with_texts=with_texts)
    elif hasattr(value, "__len__"):
        for key, item in zip(_keys(parent, value), islice(value, MAX_LISTED), strict=False):
            yield from _leaves(None, item, f"{path}[{key}]", depth - 1, with_texts=with_texts)


def _keys(parent: Any, value: Sequence[Any]) -> Iterable[str | int]:
    """Return the names of the elements of a sequence, their numbers if they have none."""
    names = _names_beside(parent, value)
    if len(names) == len(value) and len({*names}) == len(names) and all(map(_is_key, names)):
        return names
    return range(len(value))


def _index_of(name: str, parent: Any, value: Sequence[Any]) -> int | None:
    """Return the place of the element with a name."""
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


def _is_sequence(value: Any) -> bool:
    return hasattr(value, "__len__") and not isinstance(value, str) and not field_names(value)


def _is_key(name: Any) -> bool:
    """Return whether an element can be called by a name."""
    return (
        isinstance(name, str)
        and bool(re.fullmatch(r"[^\[\]]+", name))
        and isinstance(_key(name), tuple)
    )


def _is_index(key: str) -> bool:
    return bool(re.fullmatch(r"-?[0-9]{1,9}", key))
