"""The Wrench display."""

from __future__ import annotations

import math
from typing import Annotated, Any

from webviz import Color, Input, Prop, Topic
from webviz.data import messages
from webviz_displays.shared.history import HistoryLength
from webviz_displays.vectors.vector_display import VectorDisplay, VectorLook


class Wrench(VectorDisplay):
    """A force and a torque, such as those that a sensor in a wrist measures."""

    rviz = "rviz_default_plugins/Wrench"

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/WrenchStamped"), Prop(help="Topic of the wrenches.")
    ] = Topic("/wrench")
    accept_nan_values: Annotated[
        bool, Prop(rviz="Accept NaN Values", help="Draw values that are NaN as 0.")
    ] = False
    force_color: Annotated[Color, Prop(help="Colour of the force.")] = (204, 51, 51)
    torque_color: Annotated[Color, Prop(help="Colour of the torque.")] = (204, 204, 51)
    force_arrow_scale: Annotated[
        float, Prop(gt=0, unit="m/N", help="Length of the shaft per N.")
    ] = 2.0
    torque_arrow_scale: Annotated[
        float, Prop(gt=0, unit="m/Nm", help="Length of the shaft per Nm.")
    ] = 2.0
    history_length: HistoryLength = 1

    def vectors(self, message: Any) -> tuple[messages.Vector3, messages.Vector3]:
        """Force and torque."""
        wrench = message.wrench
        if self.accept_nan_values:
            return _without_nan(wrench.force), _without_nan(wrench.torque)
        return wrench.force, wrench.torque

    def looks(self) -> tuple[VectorLook, VectorLook]:
        """Force and torque."""
        return (
            VectorLook("force", "N", self.force_color, self.force_arrow_scale),
            VectorLook("torque", "Nm", self.torque_color, self.torque_arrow_scale),
        )


def _without_nan(vector: messages.Vector3) -> messages.Vector3:
    x, y, z = (0.0 if math.isnan(v) else v for v in (vector.x, vector.y, vector.z))
    return messages.Vector3(x, y, z)
