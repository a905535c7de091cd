"""Metadata for colcon, which does not read pyproject.toml; everything else is declared there."""

import re
from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_namespace_packages, setup

FOLDERS = {
    "webviz_displays": "displays/webviz_displays",
    "webviz_urdf": "urdf/webviz_urdf",
    "webviz_sim": "sim/webviz_sim",
}
DATA = """
    py.typed *.pyi *.yaml *.pgm *.urdf *.stl *.dae *.png *.webp *.json *.js *.d.ts *.css *.txt
    *.html *.msg *.srv *.action"""


def files(folder: str, *patterns: str) -> list[str]:
    """Return the files of a folder, relative to this one, as `data_files` wants them."""
    return sorted(str(path) for pattern in patterns for path in Path(folder).glob(pattern))


def readme() -> str:
    """Return the README without pictures and links to files, which only a clone has.

    colcon runs a link to this file elsewhere.
    """
    text = Path(__file__).resolve().with_name("README.md").read_text(encoding="utf-8")
    text = re.sub(r"!\[[^\]]*\]\((?!https?:)[^)]*\)\n\n", "", text)
    return re.sub(r"\[([^\]]*)\]\((?!https?:)[^)]*\)", r"\1", text)


setup(
    name="ros-webviz",
    long_description=readme(),
    long_description_content_type="text/markdown",
    # The one place of the version, which tools of ROS read there.
    version=ElementTree.parse("package.xml").findtext("version"),
    license="Apache-2.0",
    license_files=["LICENSE", "THIRD_PARTY.md"],
    python_requires=">=3.11,<3.15",
    packages=[
        name
        for folder in (".", "displays", "urdf", "sim")
        for name in find_namespace_packages(folder, include=["webviz*"])
    ],
    package_dir=FOLDERS,
    package_data={"": DATA.split()},
    entry_points={
        "console_scripts": [
            "webviz = webviz.shell.cli:program",
            "webviz-sim = webviz_sim.node:main",
        ],
        "pytest11": ["webviz = webviz.shell.pytest_plugin"],
        "webviz.displays": [
            "AccelStamped = webviz_displays.vectors:AccelStamped",
            "AerialMap = webviz_displays.outdoors:AerialMap",
            "AutowarePath = webviz_displays.autoware:AutowarePath",
            "AutowareTrajectory = webviz_displays.autoware:AutowareTrajectory",
            "Axes = webviz_displays.axes:Axes",
            "BoundingBox3D = webviz_displays.detections:BoundingBox3D",
            "BoundingBox3DArray = webviz_displays.detections:BoundingBox3DArray",
            "Camera = webviz_displays.camera:Camera",
            "CameraInfo = webviz_displays.camera_info:CameraInfo",
            "ColorOccupancyGrid = webviz_displays.octomap:ColorOccupancyGrid",
            "Costmap = webviz_displays.map:Costmap",
            "DepthCloud = webviz_displays.depth_cloud:DepthCloud",
            "DetectedObjects = webviz_displays.autoware:DetectedObjects",
            "Detection3D = webviz_displays.detections:Detection3D",
            "Detection3DArray = webviz_displays.detections:Detection3DArray",
            "Effort = webviz_displays.vectors:Effort",
            "FluidPressure = webviz_displays.sensors:FluidPressure",
            "GeoPath = webviz_displays.outdoors:GeoPath",
            "Grid = webviz_displays.grid:Grid",
            "GridCells = webviz_displays.areas:GridCells",
            "GridMap = webviz_displays.grid_map:GridMap",
            "Group = webviz.api.group:DisplayGroup",
            "Illuminance = webviz_displays.sensors:Illuminance",
            "Image = webviz_displays.image:Image",
            "ImagePlane = webviz_displays.image_plane:ImagePlane",
            "Imu = webviz_displays.imu:Imu",
            "InteractiveMarkers = webviz_displays.interactive_markers:InteractiveMarkers",
            "LaserScan = webviz_displays.laser_scan:LaserScan",
            "Mag = webviz_displays.imu:Mag",
            "Map = webviz_displays.map:Map",
            "MapCloud = webviz_displays.map_cloud:MapCloud",
            "MapGraph = webviz_displays.map_graph:MapGraph",
            "MapInfo = webviz_displays.map_info:MapInfo",
            "Marker = webviz_displays.markers:Marker",
            "MarkerArray = webviz_displays.markers:MarkerArray",
            "MotionPlanning = webviz_displays.moveit:MotionPlanning",
            "MotionPlanningTasks = webviz_displays.moveit:MotionPlanningTasks",
            "NavSatFix = webviz_displays.outdoors:NavSatFix",
            "NvbloxMesh = webviz_displays.nvblox:NvbloxMesh",
            "NvbloxVoxelBlockLayer = webviz_displays.nvblox:NvbloxVoxelBlockLayer",
            "OccupancyGrid = webviz_displays.octomap:OccupancyGrid",
            "OccupancyGridStamped = webviz_displays.octomap:OccupancyGridStamped",
            "OccupancyMap = webviz_displays.octomap:OccupancyMap",
            "OccupancyMapStamped = webviz_displays.octomap:OccupancyMapStamped",
            "Odometry = webviz_displays.odometry:Odometry",
            "ParticleCloud = webviz_displays.poses:ParticleCloud",
            "Path = webviz_displays.path:Path",
            "PlanningScene = webviz_displays.moveit:PlanningScene",
            "PointCloud = webviz_displays.sensors:PointCloud",
            "PointCloud2 = webviz_displays.point_cloud2:PointCloud2",
            "PointStamped = webviz_displays.poses:PointStamped",
            "Polygon = webviz_displays.areas:Polygon",
            "Pose = webviz_displays.poses:Pose",
            "PoseArray = webviz_displays.poses:PoseArray",
            "PoseHistory = webviz_displays.autoware:PoseHistory",
            "PoseWithCovariance = webviz_displays.poses:PoseWithCovariance",
            "PredictedObjects = webviz_displays.autoware:PredictedObjects",
            "Range = webviz_displays.sensors:Range",
            "RelativeHumidity = webviz_displays.sensors:RelativeHumidity",
            "RobotModel = webviz_displays.robot_model:RobotModel",
            "RobotState = webviz_displays.moveit:RobotState",
            "TF = webviz_displays.tf:TF",
            "Temperature = webviz_displays.sensors:Temperature",
            "Text = webviz_displays.text:Text",
            "TrackedObjects = webviz_displays.autoware:TrackedObjects",
            "Trajectory = webviz_displays.moveit:Trajectory",
            "Twist = webviz_displays.vectors:Twist",
            "TwistStamped = webviz_displays.vectors:TwistStamped",
            "VoxelGrid = webviz_displays.voxel_grid:VoxelGrid",
            "Wrench = webviz_displays.vectors:Wrench",
            "ZedOdDisplay = webviz_displays.zed:ZedOdDisplay",
        ],
        "webviz.features": [
            "bags = webviz.features.bags:BagsFeature",
            "black_box = webviz.features.black_box:BlackBoxFeature",
            "bridges = webviz.features.bridges:BridgesFeature",
            "doctor = webviz.features.doctor:DoctorFeature",
            "driving = webviz.features.driving:DrivingFeature",
            "files = webviz.features.files:FilesFeature",
            "goals = webviz.features.goals:GoalsFeature",
            "handles = webviz.features.handles:HandlesFeature",
            "latency = webviz.features.latency:LatencyFeature",
            "layouts = webviz.features.layouts:LayoutsFeature",
            "outputs = webviz.features.outputs:OutputsFeature",
            "own_past = webviz.features.own_past:OwnPastFeature",
            "panels = webviz.features.panels:PluginPanels",
            "people = webviz.features.people:People",
            "playback = webviz.features.playback:PlaybackFeature",
            "plugins = webviz.features.plugins:PluginsFeature",
            "recording = webviz.features.recording:RecordingFeature",
            "reports = webviz.features.reports:ReportsFeature",
            "rights = webviz.features.rights:RightsFeature",
            "selection = webviz.features.selection:SelectionFeature",
            "sharing = webviz.features.sharing:SharingFeature",
            "tools = webviz.features.tools:ToolsFeature",
            "topics = webviz.features.topics:TopicsFeature",
            "transforms = webviz.features.transforms:TransformsFeature",
            "undo = webviz.features.undo:UndoFeature",
            "views = webviz.features.views:ViewsFeature",
            "what_if = webviz.features.what_if:WhatIfFeature",
        ],
        "webviz.checks": ["webviz = webviz.checks"],
        "webviz.tools": [
            "GoalPose = webviz.tools.goal_pose:GoalPose",
            "Nav2Goal = webviz.tools.nav2_goal:Nav2Goal",
            "PoseEstimate = webviz.tools.pose_estimate:PoseEstimate",
            "PublishPoint = webviz.tools.publish_point:PublishPoint",
            "Teleop = webviz.tools.teleop:Teleop",
        ],
        "webviz.panels": [
            "ActionGoal = webviz.panels.calling:ActionGoal",
            "Diagnostics = webviz.panels.diagnostics:Diagnostics",
            "Docking = webviz.panels.docking:Docking",
            "Indicator = webviz.panels.indicator:Indicator",
            "Joints = webviz.panels.joints:Joints",
            "Log = webviz.panels.log:Log",
            "MessageTable = webviz.panels.table:MessageTable",
            "MotionPlanningTasks = webviz.panels.planning_tasks:MotionPlanningTasks",
            "Nav2 = webviz.panels.nav2:Nav2",
            "NodeGraph = webviz.panels.graph:NodeGraph",
            "OutdoorMap = webviz.panels.outdoor_map:OutdoorMap",
            "Parameters = webviz.panels.parameters:Parameters",
            "Plot = webviz.panels.plot:Plot",
            "PublishMessage = webviz.panels.publish:PublishMessage",
            "RawMessage = webviz.panels.raw:RawMessage",
            "RvizVisualToolsGui = webviz.panels.visual_tools:RvizVisualToolsGui",
            "SceneView = webviz.panels.scene_view:SceneView",
            "Selector = webviz.panels.selector:Selector",
            "ServiceCall = webviz.panels.calling:ServiceCall",
            "SlamToolbox = webviz.panels.slam_toolbox:SlamToolbox",
            "StateTimeline = webviz.panels.state_timeline:StateTimeline",
        ],
    },
    # What `ros2 run`, `ros2 launch` and RViz look for. RViz finds the demo robot's meshes in the
    # package webviz_urdf, by which its description names them. Links lead from ros/ to files of
    # packages, as colcon --symlink-install cannot link to those whose folder has another name.
    data_files=[
        ("share/ament_index/resource_index/packages", files("ros/resource", "*")),
        ("share/webviz", ["package.xml"]),
        ("share/webviz/launch", files("ros/launch", "*.launch.py")),
        ("share/webviz/params", files("ros/params", "*.yaml")),
        ("share/webviz/config", files("webviz/shell/cli", "*.yaml")),
        ("share/webviz/worlds", files("ros/worlds", "*.*")),
        ("share/webviz_urdf", ["ros/webviz_urdf/package.xml"]),
        ("share/webviz_urdf/demo", files("ros/robot", "*.urdf")),
        ("share/webviz_urdf/demo/meshes", files("ros/robot/meshes", "*.*")),
        ("lib/webviz", ["ros/sim"]),
    ],
)
