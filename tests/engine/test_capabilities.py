"""Capabilities of displays, with and without their base classes."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import pytest
from bench import Benches

from webviz import Context, Display, Input, Sample, Selective, Topic
from webviz.api.capabilities import CAPABILITIES, Draggable, ProtocolClient, capability
from webviz.api.connection import GraphConnection, ReceivedMessages
from webviz.api.handles import Drag, Handle
from webviz.api.tool import Gesture


class OfBefore(Display):
    """Has the hooks of capabilities by former names, as before these were base classes."""

    topic: Annotated[Topic, Input("geometry_msgs/msg/PoseStamped")] = Topic("/pose")

    def accept(self, new: Sample, kept: Sequence[Sample]) -> bool | str:
        return "refused"

    def talk(self, connection: GraphConnection, ctx: Context) -> None:
        connection.listen("/server", "std_msgs/msg/String", 1)

    def handles(self, ctx: Context) -> Mapping[str, Handle]:
        return {"m1": Handle("Knob", None, ())}


class Named(Display):
    """Has a property with the name of a hook."""

    accept: bool = True
    communicate: str = ""
    talk: str = ""


def test_a_display_without_capabilities_has_none() -> None:
    assert [capability(Named(), kind) for kind in CAPABILITIES] == [None] * len(CAPABILITIES)


@pytest.mark.filterwarnings("ignore:OfBefore.talk:DeprecationWarning")
@pytest.mark.parametrize("kind", [Draggable, ProtocolClient, Selective])
def test_a_warning_names_the_base_class_that_hooks_lack(kind: Any) -> None:
    with pytest.warns(DeprecationWarning, match=f"Derive it from webviz.{kind.__name__}, too."):
        assert capability(OfBefore(), kind)


class Renamed(Display, ProtocolClient):
    """Has the base class of a capability, and the former name of its hook."""

    def talk(self, connection: GraphConnection, ctx: Context) -> None:
        connection.wake()


def test_a_warning_says_what_a_hook_is_called_now() -> None:
    with pytest.warns(DeprecationWarning, match=r"^Renamed\.talk is communicate now"):
        client = capability(made := Renamed(), ProtocolClient)
    assert client is not None
    assert client.communicate == made.talk


@pytest.mark.parametrize(
    ("module", "former", "now"),
    [
        ("webviz.api.handles", "Grip", Drag),
        ("webviz.api.tool", "Stroke", Gesture),
        ("webviz", "Stroke", Gesture),
        ("webviz.api.wire", "Heard", ReceivedMessages),
        ("webviz.api.wire", "Wire", GraphConnection),
    ],
)
def test_former_names_still_work(module: str, former: str, now: type) -> None:
    with pytest.warns(DeprecationWarning, match=rf"{former} is [\w.]+\.{now.__name__} now"):
        assert getattr(importlib.import_module(module), former) is now


@pytest.mark.filterwarnings("ignore:OfBefore:DeprecationWarning")
def test_hooks_without_their_base_class_still_work(bench: Benches) -> None:
    b = bench(OfBefore())
    b.transform("map", "base", b.source.now)
    b.pose("/pose", "base", b.source.now)
    for _ in range(3):
        b.turn()
    assert any("refused" in text for _, text in b.statuses().values())
    assert list(b.viewer.state().handles) == [("display1", "m1")]
    assert "/server" in b.source.wanted
    client = capability(OfBefore(), ProtocolClient)
    draggable = capability(OfBefore(), Draggable)
    assert client is not None
    assert client.uses == (), "as in the base class"
    assert draggable is not None
    assert callable(draggable.drag)
