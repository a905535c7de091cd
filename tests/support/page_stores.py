"""Stores as pages receive them."""

from __future__ import annotations

from typing import Any

import msgspec

from tests.support.given_parts import GivenParts
from webviz.engine.parts.declaring import stores_of
from webviz.engine.state import State


def page_store(store: str, state: State, argument: str = "") -> dict[str, Any]:
    """Return the values of a store by key, as JSON brings them to a page."""
    given_parts = GivenParts()
    given_parts.show(state)
    (part,) = (each for each in given_parts.parts if store in stores_of(type(each)))
    content = stores_of(type(part))[store].make(part, argument)
    return {} if content is None else msgspec.json.decode(msgspec.json.encode(content.by_key()))
