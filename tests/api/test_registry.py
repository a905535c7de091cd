"""One registry for every kind of plug-in."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator

import pytest

from webviz.api import registry
from webviz.api.declared import Declared, make, to_values
from webviz.api.display import Display
from webviz.api.registry import display_types, plugin_type, plugin_types, type_name


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


def test_a_class_is_found_by_its_kind_and_name() -> None:
    assert plugin_type(Gadget, "Bell") is Bell
    assert plugin_type(Display, "Bell") is None
    assert plugin_type(Display, "LaserScan") is display_types()["LaserScan"]
    assert plugin_type(Display, "Scan") is None


def test_a_class_whose_name_another_has_is_named_by_its_own() -> None:
    other = type("LaserScan", (BellDisplay,), {})
    registry.register("b", {"OtherScan": other})
    assert type_name(other) == "OtherScan"
    assert type_name(display_types()["LaserScan"]) == "LaserScan"


STARTED = """
import sys
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.pipeline.own_names import own_names, rights_of
from webviz.files.config import standard

imported = lambda: "webviz_displays.moveit" in sys.modules
config, boundary = standard(), ErrorBoundary("", True)
rights = rights_of(config, True, (), boundary)
print(len(config.displays), imported(), rights.names == own_names(config, boundary), imported())
"""


def test_the_displays_that_a_config_lacks_are_imported_when_they_are_needed() -> None:
    result = subprocess.run([sys.executable, "-c", STARTED], capture_output=True, text=True)
    assert (result.stdout, result.stderr) == ("7 False True True\n", "")


def test_plugins_of_two_kinds_may_have_one_name() -> None:
    registry.register("b", {"Bell": BellDisplay})
    assert (plugin_types(Gadget)["Bell"], display_types()["Bell"]) == (Bell, BellDisplay)
    with pytest.raises(ValueError, match=r"^a has a gadget named Bell$"):
        registry.register("c", {"Bell": Bell})


def test_an_owner_replaces_its_own_plugins_and_no_others() -> None:
    other_bell = type("Bell", (Gadget,), {})
    registry.register("a", {"Bell": other_bell})
    assert plugin_type(Gadget, "Bell") is other_bell
    for owner in ("", "b"):
        with pytest.raises(ValueError, match=r"^a has a gadget named Bell$"):
            registry.register(owner, {"Bell": Bell})


def test_an_instance_without_a_name_is_named_by_its_title() -> None:
    bell = make(Bell, {"name": ""})
    assert bell.name == "Old Bell"
    assert to_values(bell) == {}
    assert to_values(make(Bell, {"name": "Bell"})) == {"name": "Bell"}
