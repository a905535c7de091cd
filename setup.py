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
            "AccelStamped = webviz_displays.vectors:AccelStamped",
            "Axes = webviz_displays.axes:Axes",
            "CameraInfo = webviz_displays.camera_info:CameraInfo",
            "DepthCloud = webviz_displays.depth_cloud:DepthCloud",
            "Effort = webviz_displays.vectors:Effort",
            "FluidPressure = webviz_displays.sensors:FluidPressure",
            "Grid = webviz_displays.grid:Grid",
            "GridCells = webviz_displays.areas:GridCells",
            "Group = webviz.api.group:DisplayGroup",
            "Illuminance = webviz_displays.sensors:Illuminance",
            "Image = webviz_displays.image:Image",
            "InteractiveMarkers = webviz_displays.interactive_markers:InteractiveMarkers",
            "LaserScan = webviz_displays.laser_scan:LaserScan",
            "Map = webviz_displays.map:Map",
            "Marker = webviz_displays.markers:Marker",
            "MarkerArray = webviz_displays.markers:MarkerArray",
            "Odometry = webviz_displays.odometry:Odometry",
            "ParticleCloud = webviz_displays.poses:ParticleCloud",
            "Path = webviz_displays.path:Path",
            "PointCloud = webviz_displays.sensors:PointCloud",
            "PointCloud2 = webviz_displays.point_cloud2:PointCloud2",
            "PointStamped = webviz_displays.poses:PointStamped",
            "Polygon = webviz_displays.areas:Polygon",
            "Pose = webviz_displays.poses:Pose",
            "PoseArray = webviz_displays.poses:PoseArray",
            "PoseWithCovariance = webviz_displays.poses:PoseWithCovariance",
            "Range = webviz_displays.sensors:Range",
            "RelativeHumidity = webviz_displays.sensors:RelativeHumidity",
            "RobotModel = webviz_displays.robot_model:RobotModel",
            "TF = webviz_displays.tf:TF",
            "Temperature = webviz_displays.sensors:Temperature",
            "Twist = webviz_displays.vectors:Twist",
            "TwistStamped = webviz_displays.vectors:TwistStamped",
            "Wrench = webviz_displays.vectors:Wrench",
        ],
        "webviz.tools": [
            "GoalPose = webviz.tools.goal_pose:GoalPose",
            "Nav2Goal = webviz.tools.nav2_goal:Nav2Goal",
            "PoseEstimate = webviz.tools.pose_estimate:PoseEstimate",
            "PublishPoint = webviz.tools.publish_point:PublishPoint",
            "Teleop = webviz.tools.teleop:Teleop",
        ],
        "webviz.panels": [
            "Nav2 = webviz.panels.nav2:Nav2",
        ],
    },
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/webviz"]),
        ("share/webviz", ["package.xml"]),
    ],
)
