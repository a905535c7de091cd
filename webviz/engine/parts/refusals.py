"""Errors for invalid values of properties."""

from __future__ import annotations

import functools
from typing import Any

import msgspec

from webviz.files.config import ConfigError, explain, sentences


def not_changed(
    error: msgspec.ValidationError, cls: type[msgspec.Struct], path: str, value: Any
) -> ConfigError:
    """Return the error for an invalid value of a property.

    Args:
        error: of validating the value.
        cls: the class with the property.
        path: of the property, dotted if it is nested.
        value: the invalid value.
    """
    values = functools.reduce(lambda inner, key: {key: inner}, reversed(path.split(".")), value)
    return ConfigError(f"Not changed: {sentences([explain(error, cls, values)])}")
