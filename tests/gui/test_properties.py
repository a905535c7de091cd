"""What the panel reads from a declaration."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec
import pytest
import viser

from webviz.api.declared import Prop, make, set_property
from webviz.api.display import Display
from webviz.api.properties import Property, properties_of
from webviz.api.registry import display_types
from webviz.edges.gui.controls import add_control


class Nested(msgspec.Struct, frozen=True):
    value: bool = True
    shape: Literal["Sphere", "Box"] = "Sphere"
    edge: Annotated[float, Prop(gt=0, unit="m", when=("shape", "Box"))] = 1.0


class Sample(Display):
    color_by: Literal["Intensity", "Axis", "Flat"] = "Intensity"
    use_rainbow: Annotated[bool, Prop(when=("color_by", "Intensity"))] = True
    invert_rainbow: Annotated[bool, Prop(when=("use_rainbow", True), help="Turn it round.")] = False
    size: Annotated[float, Prop(gt=0, unit="m", rviz="Size (m)")] = 0.1
    marker: Nested = Nested()


def leaves(properties: tuple[Property, ...]) -> list[Property]:
    return [
        leaf for each in properties for leaf in (leaves(each.children) if each.children else [each])
    ]


def by_path(cls: type[Display]) -> dict[str, Property]:
    return {each.path: each for each in leaves(properties_of(cls))}


def test_the_name_comes_first_and_the_rest_as_declared() -> None:
    paths = [each.path for each in properties_of(Sample)]
    assert paths == [
        *("name", "enabled"),
        *("color_by", "use_rainbow", "invert_rainbow", "size", "marker"),
    ]


def test_labels_are_rviz_names_with_the_unit_once() -> None:
    found = by_path(Sample)
    assert found["invert_rainbow"].label == "Invert Rainbow"
    assert found["size"].label == "Size (m)"
    assert found["marker.edge"].label == "Edge (m)"
    assert found["marker.value"].label == "Marker"


def test_choices_keep_the_order_of_the_declaration() -> None:
    assert by_path(Sample)["color_by"].choices == ("Intensity", "Axis", "Flat")


def test_help_becomes_the_tooltip() -> None:
    assert by_path(Sample)["invert_rainbow"].help == "Turn it round."


def test_a_property_applies_only_if_the_one_it_depends_on_does() -> None:
    inverted = by_path(Sample)["invert_rainbow"]
    assert inverted.applies(Sample())
    assert not inverted.applies(Sample(use_rainbow=False))
    assert not inverted.applies(Sample(color_by="Flat"))


def test_a_condition_within_a_nested_setting_looks_there() -> None:
    edge = by_path(Sample)["marker.edge"]
    assert not edge.applies(Sample())
    assert edge.applies(Sample(marker=Nested(shape="Box")))


def installed() -> list[Any]:
    return [
        pytest.param(cls, declared, id=f"{name}.{declared.path}")
        for name, cls in display_types().items()
        for declared in leaves(properties_of(cls))
    ]


@pytest.mark.parametrize(("cls", "declared"), installed())
def test_every_property_of_every_display_has_a_control_that_keeps_its_value(
    server: viser.ViserServer, cls: type[Display], declared: Property
) -> None:
    display = make(cls, {})
    value = declared.of(display)
    control = add_control(server.gui, declared, value, lambda *_: None)
    assert control.widget.value == control.encode(value)
    set_property(display, declared.path, control.decode(control.widget.value))
    assert declared.of(display) == value
