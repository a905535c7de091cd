"""Capabilities of displays, with and without their base classes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any

import pytest

from webviz import Context, Display, Input, Sample, Selective, Topic
from webviz.api.capabilities import CAPABILITIES, Draggable, ProtocolClient, capability
from webviz.api.handles import Handle
from webviz.api.wire import Wire


class OfBefore(Display):
    """Has the hooks of capabilities, as before these were base classes."""

    topic: Annotated[Topic, Input("geometry_msgs/msg/PoseStamped")] = Topic("/pose")

    def accept(self, new: Sample, kept: Sequence[Sample]) -> bool | str:
        return "refused"

    def talk(self, wire: Wire, ctx: Context) -> None:
        wire.listen("/server", "std_msgs/msg/String", 1)

    def handles(self, ctx: Context) -> Mapping[str, Handle]:
        return {"m1": Handle("Knob", None, ())}


class Named(Display):
    """Has a property with the name of a hook."""

    accept: bool = True
    talk: str = ""


def test_a_display_without_capabilities_has_none() -> None:
    assert [capability(Named(), kind) for kind in CAPABILITIES] == [None] * len(CAPABILITIES)


@pytest.mark.parametrize("kind", [Draggable, ProtocolClient, Selective])
def test_a_warning_names_the_base_class_that_hooks_lack(kind: Any) -> None:
    with pytest.warns(DeprecationWarning, match=f"Derive it from webviz.{kind.__name__}, too."):
        assert capability(OfBefore(), kind)


@pytest.mark.filterwarnings("ignore:OfBefore has:DeprecationWarning")
def test_hooks_without_their_base_class_still_work(bench: Callable[..., Any]) -> None:
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
    assert callable(draggable.grip)
