"""Entry points and ROS's own files; everything else stands in pyproject.toml."""

from setuptools import setup

setup(
    entry_points={
        "console_scripts": [
            "webviz = webviz.shell.cli:program",
            "webviz-sim = webviz_sim.node:main",
        ],
        "pytest11": ["webviz = webviz.shell.pytest_plugin"],
        "webviz.displays": [
            "Axes = webviz_displays.axes:Axes",
            "Group = webviz.api.group:DisplayGroup",
            "Grid = webviz_displays.grid:Grid",
            "LaserScan = webviz_displays.laser_scan:LaserScan",
            "Map = webviz_displays.map:Map",
            "Odometry = webviz_displays.odometry:Odometry",
            "Path = webviz_displays.path:Path",
            "PointCloud2 = webviz_displays.point_cloud2:PointCloud2",
            "RobotModel = webviz_displays.robot_model:RobotModel",
            "TF = webviz_displays.tf:TF",
        ],
        "webviz.tools": [
            "GoalPose = webviz.tools.goal_pose:GoalPose",
            "Nav2Goal = webviz.tools.nav2_goal:Nav2Goal",
            "PoseEstimate = webviz.tools.pose_estimate:PoseEstimate",
            "PublishPoint = webviz.tools.publish_point:PublishPoint",
            "Teleop = webviz.tools.teleop:Teleop",
        ],
    },
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/webviz"]),
        ("share/webviz", ["package.xml"]),
    ],
)
