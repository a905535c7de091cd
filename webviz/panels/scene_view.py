"""The panel 3D scene: the scene as another camera sees it, with switches of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal

import msgspec

from webviz.api.declared import Prop
from webviz.api.panel import Panel, Send, Ui
from webviz.api.views import FIXED_FRAME, target_group
from webviz.api.views.types import Pitch, Point, Yaw
from webviz.commands import SetPanelProperty
from webviz.engine.parts import visibility
from webviz.engine.state import PanelTab, Row
from webviz.panels.reading import id_of


class SceneCamera(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The camera of a 3D scene; angles and lengths as those of a view of the type Orbit.

    Seen from the top, `distance` is that of a camera with perspective to which the focal point
    appears as large, and `yaw` turns the picture.
    """

    type: Annotated[
        Literal["Orbit", "TopDownOrtho"],
        Prop(help="Around a focal point, or from above without perspective."),
    ] = "Orbit"
    target_frame: Annotated[str, Prop(widget="frame", help="The camera moves with this frame.")] = (
        FIXED_FRAME
    )
    distance: Annotated[
        float, Prop(gt=0, le=1e6, unit="m", help="From the camera to the focal point.")
    ] = 10.0
    yaw: Yaw = 0.785398
    pitch: Pitch = 0.785398
    focal_point: Annotated[Point, Prop(unit="m", help="Centre of rotation.")] = (0.0, 0.0, 0.0)


class SceneView(Panel):
    """The scene once more, with a camera and switches of displays of its own."""

    title = "3D scene"
    icon = "axes"
    opens = "below"
    module = "scene_view.js"

    view: Annotated[SceneCamera, Prop(help="Camera of this scene.")] = SceneCamera()
    displays: Annotated[
        dict[str, bool],
        Prop(
            widget="displays",
            help="Displays drawn in this scene; those of groups are named as Group > Display.",
        ),
    ] = msgspec.field(default_factory=dict)

    def __post_init__(self) -> None:
        """Begin without an id."""
        self.id = ""

    def build(self, ui: Ui, send: Send) -> None:
        """Show the scene."""
        self.send = send
        self.scene = ui.widget("scene view", {}, self._use)

    def target_frames(self) -> frozenset[str]:
        """Return the frame with which the camera moves."""
        return frozenset({self.view.target_frame} - {FIXED_FRAME})

    def show(self, rows: Sequence[Row], panels: Sequence[PanelTab]) -> None:
        """Show where the camera is, and which displays are left out."""
        self.id = id_of(self, panels)
        frame = self.view.target_frame
        group = "" if frame == FIXED_FRAME else target_group(frame)
        hidden = visibility.hidden(rows, self.displays)
        camera: Mapping[str, Any] = msgspec.to_builtins(self.view)
        self.scene.show({"view": camera, "group": group, "hidden": hidden})

    def _use(self, value: Any, browser: int | None) -> None:
        """Keep the camera as a page has moved it."""
        if self.id and isinstance(value, dict):
            self.send(SetPanelProperty(self.id, "view", value), browser)
