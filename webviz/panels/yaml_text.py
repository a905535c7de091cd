"""YAML as people enter it in panels, and as `ros2 param load` reads it."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from typing import Any

from webviz.api.errors import Error
from webviz.data.plain_yaml import YamlDocumentError, YamlLimits, read_plain

MAX_CHARACTERS = 20_000
LIMITS = YamlLimits(values=MAX_CHARACTERS, characters=MAX_CHARACTERS, depth=30, has_aliases=False)
_PLAIN = re.compile(r"[A-Za-z_/][\w/.-]*")
_WORDS = frozenset({"true", "false", "yes", "no", "on", "off", "null", "y", "n"})


def read_yaml(text: str) -> Any:
    """Return the values of a short YAML text.

    Raises:
        Error: it cannot be read; a sentence.
    """
    if len(text) > MAX_CHARACTERS:
        raise Error(f"The text has {len(text)} characters; the limit is {MAX_CHARACTERS}.")
    try:
        return read_plain(text, LIMITS)
    except YamlDocumentError as error:
        place = f"Line {error.line}" if error.line else "The text"
        raise Error(f"{place}{error.problem}") from None


def write_yaml(values: Mapping[str, Any]) -> str:
    """Plain values as YAML: mappings as blocks, lists in one line, all texts quoted."""
    return "".join(f"{line}\n" for line in _lines(values, ""))


def _lines(values: Mapping[str, Any], indent: str) -> Iterator[str]:
    for key, value in values.items():
        if isinstance(value, Mapping) and value:
            yield f"{indent}{_key(str(key))}:"
            yield from _lines(value, f"{indent}  ")
        else:
            yield f"{indent}{_key(str(key))}: {inline(value)}"


def inline(value: Any) -> str:
    """Return a value in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return _float(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=not value.isprintable())
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(str(k))}: {inline(v)}" for k, v in value.items()) + "}"
    return "[" + ", ".join(map(inline, value)) + "]"


def _float(value: float) -> str:
    if math.isnan(value):
        return ".nan"
    if math.isinf(value):
        return ".inf" if value > 0 else "-.inf"
    text = repr(value)
    mantissa, e, exponent = text.partition("e")
    # Without a dot, YAML 1.1 reads a number with an exponent as text.
    return f"{mantissa if '.' in mantissa else f'{mantissa}.0'}{e}{exponent}"


def _key(text: str) -> str:
    is_plain = _PLAIN.fullmatch(text) and text.lower() not in _WORDS
    return text if is_plain else json.dumps(text)
