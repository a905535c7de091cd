"""The viewer: `ros2 launch webviz view.launch.py config:=lab.yaml`."""

import yaml
from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {
    "config": ("", "Config to show, YAML or .rviz; empty: the template."),
    "template": ("", "Config to start with, never overwritten; empty: the usual topics."),
    "fixed_frame": ("", "Draw everything in this frame; empty: that of the config."),
    "port": ("8080", "Port of the page; 0 picks a free one."),
    "use_sim_time": ("false", "Follow the time of /clock."),
    "params_file": ("", "Parameters of the node; empty: none."),
    "open_browser": ("false", "Open the page in a browser."),
    "respawn": ("false", "Start the viewer again when it ends."),
}
"""Default and description by name."""


def generate_launch_description() -> LaunchDescription:
    """Return the launch description, as ros2 launch expects."""
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in ARGUMENTS.items()
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=_viewer)])


def _viewer(context: LaunchContext) -> list[Node]:
    def value(name: str) -> str:
        return LaunchConfiguration(name).perform(context)

    options = ["--port", value("port")]
    for option, name in (
        ("--display-config", "config"),
        ("--template", "template"),
        ("--fixed-frame", "fixed_frame"),
    ):
        if value(name):
            options += [option, value(name)]
    if yaml.safe_load(value("open_browser")):
        options.append("--open")
    files = [value("params_file")] if value("params_file") else []
    return [
        Node(
            package="webviz",
            executable="webviz",
            name="webviz",
            arguments=options,
            parameters=[*files, {"use_sim_time": yaml.safe_load(value("use_sim_time"))}],
            respawn=yaml.safe_load(value("respawn")),
            respawn_delay=1.0,
            output="screen",
        )
    ]
