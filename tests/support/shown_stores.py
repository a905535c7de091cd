"""Stores as pages receive them."""

from __future__ import annotations

from typing import Any

import msgspec

from webviz.engine.state import State
from webviz.page.content import MAKERS


def shown_by(store: str, state: State, argument: str = "") -> dict[str, Any]:
    """Return the values of a store by key, as JSON brings them to a page."""
    made = MAKERS[store](state, argument)
    return {} if made is None else msgspec.json.decode(msgspec.json.encode(made.by_key()))
