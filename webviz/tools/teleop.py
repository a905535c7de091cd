"""The tool that drives a robot from the page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from webviz.api.declared import Prop, Topic
from webviz.api.ports import Input, Output
from webviz.api.tool import Tool
from webviz.api.vehicle import Vehicle, Velocity

TWIST = "geometry_msgs/msg/Twist"


class Teleop(Tool):
    """Drive the robot: hold W A S D or arrow keys, the stick, or the left stick of a gamepad.

    The robot moves only while something is held. It brakes when that is let go, and stops when the
    page is hidden, loses its connection, or sends or receives nothing for 200 ms: webviz then
    publishes zeros itself. One browser drives at a time; another one can once the first has let go
    for a second. `Q` and `E` drive sideways if `lateral` is not 0.
    """

    title = "Teleop"
    rviz_panel = "rviz_plugin_tutorials/Teleop"
    shortcut = "t"
    order = 5
    gesture = "drive"
    icon = "wheel"

    topic: Annotated[
        Topic,
        Output(TWIST),
        Prop(help="Topic of the velocity commands."),
    ] = Topic("/cmd_vel")
    message: Annotated[
        Literal["Twist", "TwistStamped"], Prop(help="Message type of the commands.")
    ] = "Twist"
    frame_id: Annotated[
        str, Prop(when=("message", "TwistStamped"), help="Frame of stamped commands.")
    ] = "base_link"
    linear: Annotated[float, Prop(ge=0, le=50, unit="m/s", help="Highest speed ahead.")] = 0.5
    lateral: Annotated[
        float, Prop(ge=0, le=50, unit="m/s", help="Highest speed sideways; 0 if the robot cannot.")
    ] = 0.0
    angular: Annotated[float, Prop(ge=0, le=50, unit="rad/s", help="Highest turn rate.")] = 1.0
    acceleration: Annotated[float, Prop(gt=0, le=500, unit="m/s²", help="When speeding up.")] = 1.0
    deceleration: Annotated[float, Prop(gt=0, le=500, unit="m/s²", help="When braking.")] = 2.0
    angular_acceleration: Annotated[
        float, Prop(gt=0, le=500, unit="rad/s²", help="When turning faster.")
    ] = 3.0
    angular_deceleration: Annotated[
        float, Prop(gt=0, le=500, unit="rad/s²", help="When turning slower.")
    ] = 6.0
    odometry: Annotated[
        Topic,
        Input("nav_msgs/msg/Odometry"),
        Prop(help="Where speed and turn rate of the robot are read."),
    ] = Topic("/odom")

    @property
    def vehicle(self) -> Vehicle:
        """The robot with these limits."""
        is_stamped, frame_id = self.message == "TwistStamped", self.frame_id

        def message(velocity: Velocity, now_ns: int) -> Mapping[str, Any]:
            twist = {
                "linear": {"x": velocity.linear, "y": velocity.lateral},
                "angular": {"z": velocity.angular},
            }
            if not is_stamped:
                return twist
            sec, nanosec = divmod(now_ns, 1_000_000_000)
            header = {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": frame_id}
            return {"header": header, "twist": twist}

        return Vehicle(
            self.topic,
            f"{TWIST}Stamped" if is_stamped else TWIST,
            Velocity(self.linear, self.lateral, self.angular),
            Velocity(self.acceleration, self.acceleration, self.angular_acceleration),
            Velocity(self.deceleration, self.deceleration, self.angular_deceleration),
            message,
            self.odometry,
        )
