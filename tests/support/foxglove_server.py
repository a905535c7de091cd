"""A real Foxglove server with a small robot, as a process of its own.

    python foxglove_server.py PORT [OPTION ...]

Options: `plain` has no capabilities, `short` a short queue, `ahead=3` a clock that is 3 s ahead,
`named=/r1` most topics in a namespace.

It prints its address, and then what clients do, one line of JSON each: subscriptions, messages,
calls. Lines on its standard input are commands: `time SECONDS`, `status TEXT`, `stop TOPIC`,
`parameter NAME VALUE`,
`burst TOPIC COUNT SIZE`.
"""

from __future__ import annotations

import base64
import json
import sys
import threading
import time
from typing import Any

import foxglove  # pyright: ignore[reportMissingImports]
import numpy as np
from foxglove.websocket import (  # pyright: ignore[reportMissingImports]
    Capability,
    ConnectionGraph,
    MessageSchema,
    Parameter,
    ParameterType,
    Service,
    ServiceSchema,
    StatusLevel,
)

from webviz.data.messages import definition, encode, interfaces, register

PERIOD_S = 0.05
TF = "tf2_msgs/msg/TFMessage"
SCAN = "sensor_msgs/msg/LaserScan"
STRING = "std_msgs/msg/String"
MAP = "nav_msgs/msg/OccupancyGrid"
CUSTOM = "my_robot_msgs/msg/Battery"
TYPES = {
    "/tf": TF,
    "/tf_static": TF,
    "/scan": SCAN,
    "/robot_description": STRING,
    "/map": MAP,
    "/battery": CUSTOM,
    "/odd": CUSTOM,
}
BATTERY_IDL = """\
================================================================================
IDL: my_robot_msgs/msg/Battery
// generated from rosidl_adapter/resource/msg.idl.em
#include "builtin_interfaces/msg/Time.idl"
#include "std_msgs/msg/Header.idl"

module my_robot_msgs {
  module msg {
    module Battery_Constants {
      const uint8 FULL = 1;
    };
    @verbatim (language="comment", text=
      "A battery.")
    struct Battery {
      std_msgs::msg::Header header;
      float voltage;
      sequence<float> cells;
      string name;
    };
  };
};
================================================================================
IDL: std_msgs/msg/Header
#include "builtin_interfaces/msg/Time.idl"
module std_msgs { module msg { struct Header {
  builtin_interfaces::msg::Time stamp;
  string frame_id;
}; }; };
================================================================================
IDL: builtin_interfaces/msg/Time
module builtin_interfaces { module msg { struct Time { int32 sec; uint32 nanosec; }; }; };
"""
ASSETS = {
    "package://arm/a.stl": b"solid",
    "package://arm/meshes/link.obj": b"""\
mtllib red.mtl
usemtl red
v 0 0 0
v 1 0 0
v 0 1 0
f 1 2 3
""",
    "package://arm/meshes/red.mtl": b"newmtl red\nKd 1 0 0\n",
}
SET_BOOL = "std_srvs/srv/SetBool"
SET_MODE = "my_robot_msgs/srv/SetMode"
MODE_REQUEST = """\
my_robot_msgs/Mode mode
uint8[] levels
================================================================================
MSG: my_robot_msgs/Mode
string name
"""
FIXED = "/base.wheel_radius"
PARAMETERS = [
    Parameter("/base.max_speed", value=0.5),
    Parameter(FIXED, value=0.1),
    Parameter("/base.count", value=3),
    Parameter("/base.name", value="robot"),
    Parameter("/base.is_on", value=True),
    Parameter("/base.key", value=b"\x01\xff"),
    Parameter("/base.gains", value=[1.0, 2.5], type=ParameterType.Float64Array),
    Parameter("/base.joints", value=["a", "b"]),
    Parameter("/base.limits", value={"low": 1}),
    Parameter("/base.qos_overrides./tf.depth", value=10),
    Parameter("free", value="of no node"),
]
ahead_ns = 0


def say(**fact: Any) -> None:
    print(json.dumps(fact) + "\n", end="", flush=True)


class RobotChannels(foxglove.websocket.ServerListener):
    """Channels, and what clients do with them."""

    def __init__(self, namespace: str) -> None:
        self.namespace = namespace
        self.channels: dict[str, Any] = {}
        self.latched: dict[str, bytes] = {}
        self.parameters = {each.name: each for each in PARAMETERS}

    def on_subscribe(self, client: Any, channel: Any) -> None:
        say(subscribed=channel.topic)
        if (last := self.latched.get(channel.topic)) is not None:
            self.channels[channel.topic].log(last, log_time=now_ns())

    def on_unsubscribe(self, client: Any, channel: Any) -> None:
        say(unsubscribed=channel.topic)

    def on_client_advertise(self, client: Any, channel: Any) -> None:
        say(advertised=channel.topic, type=channel.schema_name, encoding=channel.encoding)

    def on_client_unadvertise(self, client: Any, client_channel_id: Any) -> None:
        say(unadvertised=True)

    def on_message_data(self, client: Any, client_channel_id: Any, data: bytes) -> None:
        say(message=base64.b64encode(data).decode())

    def on_get_parameters(
        self, client: Any, param_names: list[str], request_id: str | None = None
    ) -> list[Any]:
        return [p for name, p in self.parameters.items() if not param_names or name in param_names]

    def on_set_parameters(
        self, client: Any, parameters: list[Any], request_id: str | None = None
    ) -> list[Any]:
        for each in parameters:
            say(set=each.name)
            if each.name != FIXED:
                self.parameters[each.name] = each
        return [self.parameters[each.name] for each in parameters]

    def on_parameters_subscribe(self, param_names: list[str]) -> None:
        say(told=len(param_names))

    def add(self, topic: str, type: str) -> None:
        if type == CUSTOM:
            schema = foxglove.Schema(name=type, encoding="ros2idl", data=BATTERY_IDL.encode())
        else:
            schema = foxglove.Schema(name=type, encoding="ros2msg", data=definition(type).encode())
        name = topic if topic.startswith("/tf") else self.namespace + topic
        self.channels[topic] = foxglove.Channel(name, message_encoding="cdr", schema=schema)

    def publish(self, topic: str, values: Any) -> None:
        self.channels[topic].log(encode(TYPES[topic], values), log_time=now_ns())


def now_ns() -> int:
    """The clock of the robot."""
    return time.time_ns() + ahead_ns


def header(frame: str) -> dict[str, Any]:
    sec, nanosec = divmod(now_ns(), 1_000_000_000)
    return {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": frame}


def transform(parent: str, child: str, x: float) -> dict[str, Any]:
    pose = {"translation": {"x": x}, "rotation": {"w": 1.0}}
    return {"header": header(parent), "child_frame_id": child, "transform": pose}


def handle(request: Any) -> bytes:
    say(called=request.service_name, request=base64.b64encode(request.payload).decode())
    if request.payload[4]:
        return encode(f"{SET_BOOL}_Response", {"success": True, "message": "on"})
    raise RuntimeError("the motor is locked")


def set_mode(request: Any) -> bytes:
    return encode(f"{SET_MODE}_Response", {"said": request.payload.hex()})


def main(port: int, *options: str) -> None:
    global ahead_ns
    settings = {name: value for name, _, value in (each.partition("=") for each in options)}
    ahead_ns = round(float(settings.get("ahead", 0)) * 1e9)
    register(CUSTOM, BATTERY_IDL)
    robot = RobotChannels(settings.get("named", ""))
    for topic, type in TYPES.items():
        robot.add(topic, type)
    schema = ServiceSchema(
        SET_BOOL,
        request=MessageSchema(
            encoding="cdr",
            schema=foxglove.Schema(
                name=f"{SET_BOOL}_Request", encoding="ros2msg", data=b"bool data"
            ),
        ),
        response=MessageSchema(
            encoding="cdr",
            schema=foxglove.Schema(
                name=f"{SET_BOOL}_Response",
                encoding="ros2msg",
                data=b"bool success\nstring message",
            ),
        ),
    )

    mode = ServiceSchema(
        SET_MODE,
        request=MessageSchema(
            encoding="cdr",
            schema=foxglove.Schema(
                name=f"{SET_MODE}_Request", encoding="ros2msg", data=MODE_REQUEST.encode()
            ),
        ),
        response=MessageSchema(
            encoding="cdr",
            schema=foxglove.Schema(
                name=f"{SET_MODE}_Response", encoding="ros2msg", data=b"string said"
            ),
        ),
    )

    interfaces.service(SET_BOOL)
    interfaces.service(SET_MODE, "---\nstring said")
    services = [
        Service("/motor", schema=schema, handler=handle),
        Service("/mode", schema=mode, handler=set_mode),
    ]
    # Without capabilities, it is a server that only shows.
    is_able = "plain" not in options
    able = [
        Capability.ClientPublish,
        Capability.Services,
        Capability.ConnectionGraph,
        Capability.Parameters,
    ]
    server = foxglove.start_server(
        name="test",
        host="127.0.0.1",
        port=port,
        server_listener=robot,
        supported_encodings=["cdr"],
        capabilities=[*(able if is_able else []), Capability.Time],
        services=services if is_able else None,
        asset_handler=ASSETS.get if is_able else None,
        message_backlog_size=200 if "short" in options else None,
    )
    if is_able:
        graph = ConnectionGraph()
        graph.set_published_topic("/scan", ["/laser"])
        graph.set_published_topic("/tf", ["/robot_state_publisher", "/odometry"])
        graph.set_subscribed_topic("/cmd_vel", ["/base"])
        graph.set_advertised_service("/motor", ["/base"])
        server.publish_connection_graph(graph)
    robot.latched = {
        "/robot_description": encode(
            STRING, {"data": "<robot name='r'><link name='base'/></robot>"}
        ),
        "/tf_static": encode(TF, {"transforms": [transform("base", "laser", 0.2)]}),
    }
    say(url=f"ws://127.0.0.1:{server.port}")
    threading.Thread(target=follow, args=(robot, server), daemon=True).start()
    ranges = np.full(360, 2.0, np.float32)
    begun = time.monotonic()
    while True:
        now = time.monotonic() - begun
        robot.publish("/tf", {"transforms": [transform("odom", "base", now)]})
        scan = {"angle_max": 3.1, "angle_increment": 0.01, "range_max": 9.0, "ranges": ranges}
        robot.publish("/scan", {"header": header("laser"), **scan})
        robot.publish("/battery", {"header": header("base"), "voltage": 12.5, "name": "main"})
        time.sleep(PERIOD_S)


def follow(robot: RobotChannels, server: Any) -> None:
    """Carry out the commands of the test."""
    for line in sys.stdin:
        command, _, rest = line.strip().partition(" ")
        if command == "time":
            server.broadcast_time(round(float(rest) * 1e9))
        elif command == "status":
            server.publish_status(rest, StatusLevel.Warning, "1")
        elif command == "stop":
            robot.channels.pop(rest).close()
        elif command == "parameter":
            name, value = rest.split()
            robot.parameters[name] = Parameter(name, value=float(value))
            server.publish_parameter_values([robot.parameters[name]])
        elif command == "burst":
            topic, count, size = rest.split()
            cdr = encode(STRING, {"data": "x" * int(size)})
            for _ in range(int(count)):
                robot.channels[topic].log(cdr)
                time.sleep(0.01)
        say(done=line.strip())


if __name__ == "__main__":
    main(int(sys.argv[1]), *sys.argv[2:])
