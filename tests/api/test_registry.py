"""One registry for every kind of plug-in."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from webviz.api import registry
from webviz.api.declared import Declared, make, to_values
from webviz.api.display import Display
from webviz.api.registry import display_types, plugin_types, type_name


class Gadget(Declared):
    """Base of a kind of plug-in that webviz does not have."""

    kind = "gadget"


class Bell(Gadget):
    """A plug-in of that kind, with another title than its name."""

    title = "Old Bell"


class BellDisplay(Display):
    """A display that is registered under the same name."""


@pytest.fixture(autouse=True)
def _registered() -> Iterator[None]:
    registry.register("a", {"Bell": Bell})
    yield
    registry.register("a", {})
    registry.register("b", {})


def test_plugins_of_one_kind_are_not_among_those_of_another() -> None:
    assert plugin_types(Gadget) == {"Bell": Bell}
    assert "Bell" not in display_types()
    assert type_name(Bell) == "Bell"


def test_plugins_of_two_kinds_may_have_one_name() -> None:
    registry.register("b", {"Bell": BellDisplay})
    assert (plugin_types(Gadget)["Bell"], display_types()["Bell"]) == (Bell, BellDisplay)
    with pytest.raises(ValueError, match=r"^a has a gadget named Bell$"):
        registry.register("c", {"Bell": Bell})


def test_an_instance_without_a_name_is_named_by_its_title() -> None:
    bell = make(Bell, {"name": ""})
    assert bell.name == "Old Bell"
    assert to_values(bell) == {}
    assert to_values(make(Bell, {"name": "Bell"})) == {"name": "Bell"}
