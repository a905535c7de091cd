"""Messages as the JSON values of rosbridge, which takes no CDR."""

from __future__ import annotations

import base64
import binascii
import math
import struct
from collections.abc import Mapping
from typing import Any

from webviz.data.messages import DecodeError, EncodeError, encode
from webviz.data.messages.cdr import CdrError, Reader
from webviz.data.messages.classes import DTYPES
from webviz.data.messages.typestore import PLACEHOLDER, MessageField, fields, weight

_BYTES = ("uint8", "char")
"""Arrays of these are texts in base64."""


def to_values(type: str, cdr: bytes) -> dict[str, Any]:
    """Return the values of a message.

    Raises:
        MessageError: the bytes are not of this type, or it is unknown.
    """
    try:
        return _message(type, Reader(cdr))
    except (CdrError, struct.error) as error:
        raise DecodeError(f"Not a {type}: {error}.") from error


def from_values(type: str, values: Mapping[str, Any]) -> bytes:
    """Return a message in CDR.

    Raises:
        MessageError: the values are not of this type, or it is unknown.
    """
    return encode(type, _completed(type, values))


def _message(type: str, reader: Reader) -> dict[str, Any]:
    values = {field.name: _value(field, reader) for field in fields(type)}
    values.pop(PLACEHOLDER[0], None)  # unknown to rosbridge
    return values


def _value(field: MessageField, reader: Reader) -> Any:
    if field.size is None:
        return _one(field, reader)
    if (dtype := DTYPES.get(field.base)) is not None:
        array = reader.array(dtype, field.size or reader.count())
        if field.base in _BYTES:
            return base64.b64encode(array.tobytes()).decode()
        return array.tolist()
    each = weight(field.base) if field.is_message else 1
    return [_one(field, reader) for _ in range(reader.elements(field.size, each))]


def _one(field: MessageField, reader: Reader) -> Any:
    if field.is_message:
        return _message(field.base, reader)
    if (dtype := DTYPES.get(field.base)) is not None:
        return reader.array(dtype, 1).item()
    if field.base == "string":
        return reader.string()
    if field.base == "wstring":
        return reader.wstring()
    raise DecodeError(f"Fields of type {field.base}, such as {field.name}, are not supported.")


def _completed(type: str, values: Any) -> Any:
    """Return values as the encoder takes them; what does not fit is left to it."""
    if not isinstance(values, Mapping):
        return values
    by_name = {field.name: field for field in fields(type)}
    return {
        name: _given_value(by_name[name], value) if name in by_name else value
        for name, value in values.items()
    }


def _given_value(field: MessageField, value: Any) -> Any:
    if field.size is not None and field.base in _BYTES and isinstance(value, str):
        try:
            return base64.b64decode(value, validate=True)
        except binascii.Error as error:
            raise EncodeError(f"{field.name} is not base64.") from error
    if field.size is not None and isinstance(value, list):
        return [_given_one(field, each) for each in value]
    return _given_one(field, value)


def _given_one(field: MessageField, value: Any) -> Any:
    if field.is_message:
        return _completed(field.base, value)
    # JSON has no NaN and no infinity; rosbridge writes both as null.
    return math.nan if value is None and field.base in ("float32", "float64") else value
