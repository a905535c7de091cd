"""A simulated robot and the viewer: `ros2 launch webviz demo.launch.py`."""

from pathlib import Path

import yaml
from ament_index_python.packages import get_package_share_directory
from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

SHARE = Path(get_package_share_directory("webviz"))
ARGUMENTS = {
    "config": ("", "Config to show, YAML or .rviz; empty: the template."),
    "template": (str(SHARE / "config" / "demo.yaml"), "Config to start with, never overwritten."),
    "world": ("", "Map to drive in, a yaml for nav2's map_server; empty: as the parameters say."),
    "robot": ("", "URDF of the robot; empty: that of the parameters."),
    "port": ("8080", "Port of the page; 0 picks a free one."),
    "use_sim_time": ("false", "Let the simulator publish /clock, and the viewer follow it."),
    "stamped_cmd_vel": ("", "Take TwistStamped on /cmd_vel; empty: as the parameters say."),
    "params_file": (str(SHARE / "params" / "demo.yaml"), "Parameters of both nodes."),
    "open_browser": ("false", "Open the page in a browser."),
    "respawn": ("false", "Start a node again when it ends."),
}
"""Default and description by name."""


def generate_launch_description() -> LaunchDescription:
    """Return the launch description, as ros2 launch expects."""
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in ARGUMENTS.items()
    ]
    viewer = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(str(SHARE / "launch" / "view.launch.py"))
    )
    return LaunchDescription([*arguments, OpaqueFunction(function=_simulator), viewer])


def _simulator(context: LaunchContext) -> list[Node]:
    def value(name: str) -> str:
        return LaunchConfiguration(name).perform(context)

    # What is not given comes from the file.
    given = {name: value(name) for name in ("world", "robot") if value(name)}
    if value("stamped_cmd_vel"):
        given["stamped_cmd_vel"] = yaml.safe_load(value("stamped_cmd_vel"))
    if yaml.safe_load(value("use_sim_time")):
        given["publish_clock"] = True
    return [
        Node(
            package="webviz",
            executable="sim",
            name="sim",
            parameters=[value("params_file"), given],
            respawn=yaml.safe_load(value("respawn")),
            respawn_delay=1.0,
            output="screen",
        )
    ]
