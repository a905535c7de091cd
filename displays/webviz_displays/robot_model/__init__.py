"""A robot as its description says, where its transforms say."""

from webviz_displays.robot_model.display import RobotModel

__all__ = ["RobotModel"]
