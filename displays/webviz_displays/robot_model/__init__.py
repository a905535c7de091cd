"""The RobotModel display."""

from webviz_displays.robot_model.display import RobotModel

__all__ = ["RobotModel"]
