"""A decoder for any message type, built once from its definition.

Neighbouring fields of fixed size, nested messages included, are read by a single `struct` call;
numeric arrays become views. Their padding depends on the position of the first one only
modulo 8, so a run of fixed fields has at most eight layouts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import groupby, islice
from struct import Struct
from typing import Any

from webviz.data.messages.cdr import ENCAPSULATION_SIZE, CdrError, Reader
from webviz.data.messages.classes import CODES, DTYPES, VECTORS, message_class
from webviz.data.messages.sequences import SEQUENCE_READERS
from webviz.data.messages.typestore import (
    MessageField,
    MessageTypes,
    fields,
    full_name,
    per_definitions,
    weight,
)

Step = Callable[[Reader, list[Any]], None]
"""Reads one or several fields and appends them."""
Read = Callable[[Reader], Any]
Build = Callable[[Iterator[Any]], Any]
"""Consumes the numbers of one field from an iterator."""


@per_definitions
def decoder(type_name: str, order: str, types: MessageTypes) -> Read:
    """Return the function that reads a message of this type from a `Reader` of this byte order.

    Raises:
        UnknownTypeError: No definition of the type, or of one it holds, is known.
    """
    make = message_class(type_name, types)
    steps: list[Step] = []
    own = fields(type_name, types)
    for fixed, group in groupby(own, lambda field: _codes(field, types) is not None):
        run = list(group)
        if fixed:
            steps.append(_run(run, order, types))
        else:
            steps += [_step(field, order, types) for field in run]

    def read(reader: Reader) -> Any:
        values: list[Any] = []
        for step in steps:
            step(reader, values)
        return make(*values)

    return read


def _codes(field: MessageField, types: MessageTypes) -> str | None:
    """Return the `struct` codes of a field of fixed size, else None."""
    if field.size is not None:
        return None
    if not field.is_message:
        return CODES.get(field.base)
    inner = [_codes(f, types) for f in fields(field.base, types)]
    return None if None in inner else "".join(filter(None, inner))


def _run(run: list[MessageField], order: str, types: MessageTypes) -> Step:
    """Read neighbouring fields of fixed size at once."""
    codes = "".join(_codes(field, types) or "" for field in run)
    layouts = [_layout(codes, order, start) for start in range(8)]
    builds = [_build(field, types) for field in run]
    nested = any(field.is_message for field in run)

    def step(reader: Reader, values: list[Any]) -> None:
        layout = layouts[reader.pos & 7]
        numbers = layout.unpack_from(reader.data, reader.pos)
        reader.pos += layout.size
        if nested:
            rest = iter(numbers)
            values.extend([build(rest) for build in builds])
        else:
            values.extend(numbers)

    return step


def _layout(codes: str, order: str, start: int) -> Struct:
    """Codes with their padding if the first byte is at `start` modulo 8."""
    padded = ""
    pos = start - ENCAPSULATION_SIZE
    for code in codes:
        size = Struct(order + code).size
        padded += "x" * (-pos % size) + code
        pos += -pos % size + size
    return Struct(order + padded)


def _build(field: MessageField, types: MessageTypes) -> Build:
    if not field.is_message:
        return next
    make = message_class(field.base, types)
    inner = fields(field.base, types)
    if not any(f.is_message for f in inner):
        count = len(inner)
        return lambda numbers: make(*islice(numbers, count))
    builds = [_build(f, types) for f in inner]
    return lambda numbers: make(*[build(numbers) for build in builds])


def _step(field: MessageField, order: str, types: MessageTypes) -> Step:
    """Read one field of varying size, or an array."""
    read = _reader_of(field, order, types)
    return lambda reader, values: values.append(read(reader))


def _reader_of(field: MessageField, order: str, types: MessageTypes) -> Read:
    base, size = field.base, field.size
    if size == 0 and base in SEQUENCE_READERS:
        return SEQUENCE_READERS[base]
    if size is not None and base in DTYPES:
        return _array_of(base, 1, size)
    if size is not None and base in VECTORS:
        return _array_of(*VECTORS[base], size)
    one = _reader_of_one(field, order, types)
    if size is None:
        return one
    each = weight(base, types) if field.is_message else 1
    return lambda reader: [one(reader) for _ in range(reader.elements(size, each))]


def _array_of(base: str, width: int, size: int) -> Read:
    """Return an array of numbers, (N,) or (N, width); a sequence if `size` is 0."""
    dtype = DTYPES[base]

    def read(reader: Reader) -> Any:
        numbers = reader.array(dtype, width * (size or reader.count()))
        return numbers if width == 1 else numbers.reshape(-1, width)

    return read


def _reader_of_one(field: MessageField, order: str, types: MessageTypes) -> Read:
    if field.is_message:
        return decoder(full_name(field.base), order, types)
    if field.base == "string":
        return Reader.string
    if field.base == "wstring":
        return Reader.wstring

    def refuse(reader: Reader) -> Any:
        raise CdrError(f"fields of type {field.base}, such as {field.name}, are not supported")

    return refuse
