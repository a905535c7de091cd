"""Driving: set-points of browsers become velocity commands, beside the frame loop."""

from webviz.engine.driving.velocity_controller import DrivingAnswer
from webviz.engine.driving.velocity_controllers import VelocityControllers

__all__ = ["DrivingAnswer", "VelocityControllers"]
