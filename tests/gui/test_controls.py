"""Properties as widgets hold them."""

from __future__ import annotations

from typing import Any

import pytest
import viser

from webviz.api.display import Display
from webviz.api.properties import properties_of
from webviz.edges.gui.control import Choice
from webviz.edges.gui.controls import add_control
from webviz_displays.robot_model import RobotModel


class Lists(Display):
    prefixes: list[str]
    shown: dict[str, bool]
    numbers: list[float]
    covariance: tuple[float, float, float, float]


PROPERTIES = {each.path: each for each in properties_of(Lists)}


@pytest.mark.parametrize(
    ("path", "value", "text"),
    [
        ("prefixes", ["front", "rear left"], "front\nrear left"),
        ("prefixes", ["true", "12", "a: b"], "true\n12\na: b"),
        ("prefixes", [], ""),
        ("shown", {"base_link": True, "a:b": False}, "base_link: true\na:b: false"),
        ("numbers", [1.5, -2.0], "1.5\n-2.0"),
        ("covariance", (1.0, 0.0, 0.5, 2.0), "1.0\n0.0\n0.5\n2.0"),
    ],
)
def test_lists_and_mappings_have_an_entry_per_line(
    server: viser.ViserServer, path: str, value: Any, text: str
) -> None:
    control = add_control(server.gui, PROPERTIES[path], value, lambda *_: None)
    assert control.widget.value == text
    decoded = control.decode(text)
    assert type(value)(decoded) == value


@pytest.mark.parametrize("text", ["base_link", "base_link: yes", ":"])
def test_a_line_that_means_nothing_is_refused(server: viser.ViserServer, text: str) -> None:
    control = add_control(server.gui, PROPERTIES["shown"], {}, lambda *_: None)
    with pytest.raises(ValueError, match="is not valid"):
        control.decode(text)


def test_a_choice_offers_the_current_value_even_if_nobody_knows_it(
    server: viser.ViserServer,
) -> None:
    choice = Choice(server.gui, "Frame", "map", lambda *_: None)
    choice.offer(("base_link", "odom"), "map")
    assert choice.dropdown.options == ("base_link", "odom", "map")
    choice.offer(("base_link", "map", "odom"), "map")
    assert choice.dropdown.options == ("base_link", "map", "odom")
    assert choice.dropdown.value == "map"


def test_an_empty_choice_can_be_read(server: viser.ViserServer) -> None:
    choice = Choice(server.gui, "Topic", "", lambda *_: None)
    assert choice.dropdown.value == "(none)"
    assert choice.decode("(none)") == ""


def test_a_mapping_may_hold_settings_that_have_colons_themselves(
    server: viser.ViserServer,
) -> None:
    text = 'base_link: {"alpha":0.5,"show_axes":true}'
    property_ = {each.path: each for each in properties_of(RobotModel)}["links"]
    control = add_control(server.gui, property_, {}, lambda *_: None)
    assert control.decode(text) == {"base_link": {"alpha": 0.5, "show_axes": True}}
