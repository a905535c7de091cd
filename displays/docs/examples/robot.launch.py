"""A launch file: the simulated robot, and a viewer that shows it.

Start it with `ros2 launch ./robot.launch.py`.
"""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """Return the launch description, as ros2 launch expects."""
    view = PythonLaunchDescriptionSource([FindPackageShare("webviz"), "/launch/view.launch.py"])
    return LaunchDescription(
        [
            Node(package="webviz", executable="sim", parameters=[{"tour_speed": 0.5}]),
            IncludeLaunchDescription(view, launch_arguments={"fixed_frame": "map"}.items()),
        ]
    )
