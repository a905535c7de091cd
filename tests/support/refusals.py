"""Refusals of the Python interface."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import webviz


def refusal_of(action: Callable[[], object]) -> str:
    """Return the one sentence with which an action is refused."""
    with pytest.raises(webviz.Error) as excinfo:
        action()
    assert "\n" not in str(excinfo.value)
    return str(excinfo.value)
