"""Layouts: panels beside, below and over the scene."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated, TypeVar

import msgspec

from webviz.api.declared import Prop

MAX_DOCKED = 20
"""Panels in one place of a layout."""
MAX_LAYOUTS = 20
"""Saved ones. To read so many, with all places full, takes a second, to write them half of that."""
PanelName = Annotated[
    str,
    msgspec.Meta(min_length=1, max_length=100),
    Prop(help="Name of the panel: doctor, topics and so on, Plot, or Plot 2 for the second."),
]


P = TypeVar("P", bound="DockedPanel | FloatingPanel")


class DockedPanel(
    msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True, kw_only=True
):
    """A panel beside or below the scene."""

    panel: PanelName
    weight: Annotated[
        float, Prop(ge=0.05, le=20, help="Its size relative to the others of its place.")
    ] = 1.0


class FloatingPanel(
    msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True, kw_only=True
):
    """A panel over the scene; all numbers are shares of the size of the scene."""

    panel: PanelName
    left: Annotated[float, Prop(ge=0, le=1, help="Left edge.")] = 0.6
    top: Annotated[float, Prop(ge=0, le=1, help="Upper edge.")] = 0.1
    width: Annotated[float, Prop(ge=0.05, le=1, help="Width.")] = 0.35
    height: Annotated[float, Prop(ge=0.05, le=1, help="Height.")] = 0.4


class Layout(
    msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True, kw_only=True
):
    """Panels around the scene. A panel stands in one place; the others are tabs."""

    beside: Annotated[
        tuple[DockedPanel, ...],
        msgspec.Meta(max_length=MAX_DOCKED),
        Prop(help="Panels to the right of the scene, from top to bottom."),
    ] = ()
    below: Annotated[
        tuple[DockedPanel, ...],
        msgspec.Meta(max_length=MAX_DOCKED),
        Prop(help="Panels below the scene, from left to right."),
    ] = ()
    over: Annotated[
        tuple[FloatingPanel, ...],
        msgspec.Meta(max_length=MAX_DOCKED),
        Prop(help="Panels over the scene, the last on top."),
    ] = ()
    width: Annotated[
        float, Prop(ge=120, le=4000, unit="px", help="Width of the panels beside the scene.")
    ] = 340.0
    height: Annotated[
        float, Prop(ge=80, le=4000, unit="px", help="Height of the panels below the scene.")
    ] = 240.0

    def __post_init__(self) -> None:
        """Refuse a panel that is placed twice.

        Raises:
            ValueError: as a sentence.
        """
        names = [each.panel for each in (*self.beside, *self.below, *self.over)]
        twice = next((name for at, name in enumerate(names) if name in names[:at]), None)
        if twice is not None:
            raise ValueError(f"the panel {twice} is placed twice; a panel stands in one place")

    def renamed(self, names: Mapping[str, str]) -> Layout:
        """Return the layout with other names of panels; those whose new name is "" are left out."""

        def place(panels: Iterable[P]) -> tuple[P, ...]:
            wanted = [(each, names.get(each.panel, each.panel)) for each in panels]
            return tuple(msgspec.structs.replace(each, panel=new) for each, new in wanted if new)

        return msgspec.structs.replace(
            self, beside=place(self.beside), below=place(self.below), over=place(self.over)
        )
