"""Capabilities of displays, which they opt into with base classes."""

from __future__ import annotations

from webviz import Display, Selective
from webviz.api.capabilities import CAPABILITIES, Draggable, ProtocolClient, capability


class Named(Display):
    """Has properties with the names of hooks."""

    accept: bool = True
    communicate: str = ""


class Docking(Display, Draggable, Selective):
    """Has the base classes of capabilities."""


def test_a_display_without_capabilities_has_none() -> None:
    assert [capability(Named(), kind) for kind in CAPABILITIES] == [None] * len(CAPABILITIES)


def test_a_display_is_its_own_capability() -> None:
    display = Docking()
    results = {kind for kind in CAPABILITIES if capability(display, kind) is display}
    assert results == {Draggable, ProtocolClient, Selective}
