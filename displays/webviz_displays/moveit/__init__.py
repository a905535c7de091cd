"""The displays of MoveIt: planning scenes, states and trajectories of a robot."""

from webviz_displays.moveit.motion_planning import MotionPlanning
from webviz_displays.moveit.planning_scene import PlanningScene
from webviz_displays.moveit.planning_tasks import MotionPlanningTasks
from webviz_displays.moveit.robot_state import RobotState
from webviz_displays.moveit.trajectory import Trajectory

__all__ = ["MotionPlanning", "MotionPlanningTasks", "PlanningScene", "RobotState", "Trajectory"]
