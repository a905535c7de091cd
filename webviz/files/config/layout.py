"""Layouts: panels beside, below and over the scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

import msgspec

from webviz.api.declared import Prop

MAX_DOCKED = 20
"""Panels in one place of a layout."""
MAX_LAYOUTS = 20
"""Saved ones. To read so many, with all places full, takes a second, to write them half of that."""
PanelName = Annotated[
    str,
    msgspec.Meta(min_length=1, max_length=100),
    Prop(
        help="Name of the panel: doctor, topics and so on, Plot, Plot 2 for the second, or image: "
        "and the name of a display with a picture."
    ),
]


class DockedPanel(
    msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True, kw_only=True
):
    """A panel beside or below the scene, and those behind it, of which tabs show one at a time."""

    panel: PanelName
    weight: Annotated[
        float, Prop(ge=0.05, le=20, help="Its size relative to the others of its place.")
    ] = 1.0
    tabs: Annotated[
        tuple[PanelName, ...],
        msgspec.Meta(max_length=MAX_DOCKED),
        Prop(help="Further panels in its place, as tabs."),
    ] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """All panels of this place."""
        return self.panel, *self.tabs

    def renamed(self, names: Mapping[str, str]) -> DockedPanel | None:
        """Return it with other names of panels, without those that become ""; None if empty."""
        new = [name for each in self.names if (name := names.get(each, each))]
        if not new:
            return None
        return msgspec.structs.replace(self, panel=new[0], tabs=tuple(new[1:]))


class FloatingPanel(
    msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True, kw_only=True
):
    """A panel over the scene; all numbers are shares of the size of the scene."""

    panel: PanelName
    left: Annotated[float, Prop(ge=0, le=1, help="Left edge.")] = 0.6
    top: Annotated[float, Prop(ge=0, le=1, help="Upper edge.")] = 0.1
    width: Annotated[float, Prop(ge=0.05, le=1, help="Width.")] = 0.35
    height: Annotated[float, Prop(ge=0.05, le=1, help="Height.")] = 0.4

    @property
    def names(self) -> tuple[str, ...]:
        """Its panel, as those of `DockedPanel`."""
        return (self.panel,)

    def renamed(self, names: Mapping[str, str]) -> FloatingPanel | None:
        """Return it with another name of its panel; None if that is ""."""
        new = names.get(self.panel, self.panel)
        return msgspec.structs.replace(self, panel=new) if new else None


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
        names = list(self.names)
        twice = next((name for at, name in enumerate(names) if name in names[:at]), None)
        if twice is not None:
            raise ValueError(f"the panel {twice} is placed twice; a panel stands in one place")

    @property
    def names(self) -> tuple[str, ...]:
        """The panels that are not in the tabs at the side."""
        return tuple(name for each in self._places for name in each.names)

    @property
    def _places(self) -> tuple[DockedPanel | FloatingPanel, ...]:
        return (*self.beside, *self.below, *self.over)

    def renamed(self, names: Mapping[str, str]) -> Layout:
        """Return the layout with other names of panels; those whose new name is "" are left out."""
        return msgspec.structs.replace(
            self,
            beside=tuple(new for each in self.beside if (new := each.renamed(names))),
            below=tuple(new for each in self.below if (new := each.renamed(names))),
            over=tuple(new for each in self.over if (new := each.renamed(names))),
        )

    def with_panel_below(self, panel: str) -> Layout:
        """Return the layout with one more panel below the scene: as a tab of the last one there."""
        if panel in self.names:
            return self
        if not self.below or len(self.below[-1].tabs) == MAX_DOCKED:
            return msgspec.structs.replace(self, below=(*self.below, DockedPanel(panel=panel)))
        *others, last = self.below
        joined = msgspec.structs.replace(last, tabs=(*last.tabs, panel))
        return msgspec.structs.replace(self, below=(*others, joined))
