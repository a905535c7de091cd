"""Properties that several displays of MoveIt share."""

from __future__ import annotations

from typing import Annotated

import msgspec

from webviz import Color, Input, Prop, Topic
from webviz_displays.moveit.octomap import Coloring, Rendering
from webviz_displays.robot_model.parts import LinkSettings
from webviz_displays.shared.colors import Alpha

RobotDescription = Annotated[
    Topic,
    Input("std_msgs/msg/String", latched=True, optional=True, is_plain=True, is_offered=False),
    Prop(help="Topic of the robot's URDF."),
]
ROBOT_DESCRIPTION = Topic("robot_description")
"""Its default, which is also the name of MoveIt's parameter."""

PlanningSceneTopic = Annotated[
    Topic,
    Input("moveit_msgs/msg/PlanningScene", is_plain=True),
    Prop(help="Topic of the scene and of its changes."),
]
MoveGroupNamespace = Annotated[
    str, Prop(help="Namespace of move_group, from which the first scene is requested.")
]
ShowVisual = Annotated[bool, Prop(help="Draw the links' visual shapes.")]
ShowCollision = Annotated[bool, Prop(help="Draw the links' collision shapes.")]
RobotAlpha = Annotated[Alpha, Prop(help="Opacity of the links.")]
AttachedBodyColor = Annotated[
    Color, Prop(help="Colour of the objects that the robot holds, if they have none.")
]
AllLinks = Annotated[
    bool,
    Prop(rviz="Links/All Links Enabled", help="Draw the links that have no settings of their own."),
]
Links = Annotated[dict[str, LinkSettings], Prop(help="Settings of single links by name.")]

SceneAlpha = Annotated[Alpha, Prop(help="Opacity of objects without a colour.")]
SceneColor = Annotated[Color, Prop(help="Colour of objects without one.")]
VoxelRendering = Annotated[Rendering, Prop(help="Which voxels of the octomap to draw.")]
VoxelColoring = Annotated[
    Coloring,
    Prop(help="Z-Axis: magenta (low) to red (high). Cell Probability: red to green (occupied)."),
]

ATTACHED = (150, 50, 150)
"""RViz's colour of what a robot holds."""
OBJECTS = (50, 230, 50)
"""RViz's colour of what stands around."""


class SceneGeometry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the objects of a scene."""

    show_scene_geometry: Annotated[bool, Prop(help="Draw the objects of the scene.")] = True
    scene_alpha: SceneAlpha = 0.9
    scene_color: SceneColor = OBJECTS
    voxel_rendering: VoxelRendering = "Occupied Voxels"
    voxel_coloring: VoxelColoring = "Z-Axis"
    scene_display_time: Annotated[
        float, Prop(ge=0.0001, unit="s", help="Minimum time between moves of the robot.")
    ] = 0.01


class SceneRobot(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the robot of a scene."""

    show_robot_visual: ShowVisual = True
    show_robot_collision: ShowCollision = False
    robot_alpha: RobotAlpha = 1.0
    attached_body_color: AttachedBodyColor = ATTACHED
    all_links_enabled: AllLinks = True
    links: Links = msgspec.field(default_factory=dict)


TrajectoryTopic = Annotated[
    Topic,
    Input("moveit_msgs/msg/DisplayTrajectory", is_plain=True),
    Prop(help="Topic of the planned paths."),
]
StateDisplayTime = Annotated[
    str,
    Prop(
        help="Speed of the animation: a factor of the path's own time such as 3x, or a time for "
        "each point such as 0.05s."
    ),
]
UseSimTime = Annotated[bool, Prop(help="Animate by the time that is shown, not by real time.")]
LoopAnimation = Annotated[bool, Prop(help="Play the newest path again and again.")]
ShowTrail = Annotated[bool, Prop(help="Draw the robot at all points that were passed.")]
TrailStepSize = Annotated[
    int,
    Prop(ge=1, when=("show_trail", True), help="Points from one state of the trail to the next."),
]
InterruptDisplay = Annotated[
    bool, Prop(help="Show a new path at once, instead of after the current animation.")
]
ColorEnabled = Annotated[bool, Prop(help="Draw the robot in one colour.")]
RobotColor = Annotated[
    Color, Prop(when=("color_enabled", True), help="Colour of the animated robot.")
]
Paused = Annotated[bool, Prop(help="Show one point of the path instead of the animation.")]
Position = Annotated[
    float, Prop(ge=0, le=1, when=("paused", True), help="Which point: 0 is the first, 1 the last.")
]


class PlannedPath(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Animation of a planned path."""

    show_robot_visual: ShowVisual = True
    show_robot_collision: ShowCollision = False
    robot_alpha: RobotAlpha = 0.5
    state_display_time: StateDisplayTime = "3x"
    use_sim_time: UseSimTime = False
    loop_animation: LoopAnimation = False
    show_trail: ShowTrail = False
    trail_step_size: TrailStepSize = 1
    interrupt_display: InterruptDisplay = False
    robot_color: RobotColor = ATTACHED
    color_enabled: ColorEnabled = False
    paused: Paused = False
    position: Position = 1.0
    all_links_enabled: AllLinks = True
    links: Links = msgspec.field(default_factory=dict)


class PlanningRequest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the two ends of a plan."""

    show_workspace: Annotated[bool, Prop(help="Draw the box in which plans may move.")] = False
    query_start_state: Annotated[bool, Prop(help="Draw the robot where a plan begins.")] = False
    query_goal_state: Annotated[bool, Prop(help="Draw the robot where a plan ends.")] = True
    start_state_color: Annotated[
        Color,
        Prop(when=("query_start_state", True), help="Colour of the links that the plan moves."),
    ] = (0, 255, 0)
    start_state_alpha: Annotated[
        Alpha, Prop(when=("query_start_state", True), help="Opacity at the start.")
    ] = 1.0
    goal_state_color: Annotated[
        Color,
        Prop(when=("query_goal_state", True), help="Colour of the links that the plan moves."),
    ] = (250, 128, 0)
    goal_state_alpha: Annotated[
        Alpha, Prop(when=("query_goal_state", True), help="Opacity at the goal.")
    ] = 1.0
    joint_violation_color: Annotated[
        Color, Prop(help="Colour of links whose joint is outside its limits.")
    ] = (255, 0, 255)
