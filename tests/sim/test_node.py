import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from waiting import until

pytest.importorskip("rclpy", reason="rclpy is not installed", exc_type=ImportError)

from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, Twist, TwistStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from nodes import response_of
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from rosbags.typesys import Stores, get_typestore
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, LaserScan
from std_msgs.msg import String
from std_srvs.srv import Empty

from webviz.ros.types import message_class
from webviz_sim.lidar import cast_rays
from webviz_sim.node import main
from webviz_sim.options import BUILDING, OPTIONS
from webviz_sim.pose import Pose2D
from webviz_sim.world import load_world

# rclpy's own imports: the parser of an old lark uses a module that Python 3.11 deprecates.
pytestmark = [
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),
    pytest.mark.usefixtures("webviz_domain"),
]

Simulators = Callable[..., subprocess.Popen[str]]
Refusals = Callable[..., tuple[object, str, str]]
ROOT = Path(__file__).parents[2]
STORE = get_typestore(Stores.ROS2_JAZZY)
ODOMETRY_S = 0.02
"""Period of /odom."""
LATCHED = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
TOPICS = {
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/odom": "nav_msgs/msg/Odometry",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/map": "nav_msgs/msg/OccupancyGrid",
    "/path": "nav_msgs/msg/Path",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/robot_description": "std_msgs/msg/String",
}


def environment() -> dict[str, str]:
    paths = [str(ROOT), *(str(ROOT / folder) for folder in ("displays", "urdf", "sim"))]
    return os.environ | {"PYTHONPATH": os.pathsep.join([*paths, *sys.path[1:]])}


@pytest.fixture
def sim() -> Iterator[Simulators]:
    """Start the simulator in a process of its own and stop it as Ctrl-C does."""
    started = []

    def start(*parameters: str) -> subprocess.Popen[str]:
        ros_args = [word for parameter in parameters for word in ("-p", parameter)]
        process = subprocess.Popen(
            [sys.executable, "-m", "webviz_sim", "--ros-args", *ros_args],
            env=environment(),
            stderr=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        assert process.returncode == 0
        assert "Traceback" not in errors


class RobotClient(Node):
    """A node that receives what the robot publishes, and sends it commands."""

    def __init__(self, context: Context) -> None:
        super().__init__("test_viewer", context=context)
        self.executor_ = SingleThreadedExecutor(context=context)
        self.executor_.add_node(self)
        self.received = {}

    def listen(
        self, topic: str, kind: type[Any], qos: QoSProfile | int = 10, raw: bool = False
    ) -> list[Any]:
        self.received[topic] = []
        self.create_subscription(kind, topic, self.received[topic].append, qos, raw=raw)
        return self.received[topic]

    def listen_tf(self) -> None:
        kind = message_class("tf2_msgs/msg/TFMessage")
        self.listen("/tf", kind, 100, raw=True)
        self.listen("/tf_static", kind, LATCHED, raw=True)

    def transforms(self, topic: str = "/tf") -> list[tuple[int, str, str, Any]]:
        """All transforms so far as (stamp in ns, parent, child, transform)."""
        results = []
        for raw in self.received[topic]:
            message: Any = STORE.deserialize_cdr(bytes(raw), "tf2_msgs/msg/TFMessage")
            for t in message.transforms:
                stamp = nanoseconds(t.header.stamp)
                results.append((stamp, t.header.frame_id, t.child_frame_id, t.transform))
        return results

    def pose(self, topic: str = "/odom") -> Pose2D:
        return planar(self.received[topic][-1].pose.pose)

    def spin(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while (rest := end - time.monotonic()) > 0:
            self.executor_.spin_once(timeout_sec=rest)

    def spin_until(self, condition: Callable[[], object]) -> None:
        until(condition, turn=lambda: self.executor_.spin_once(timeout_sec=0.05))

    def drive(self, twist: Twist, seconds: float) -> None:
        """Send a velocity at 20 Hz until /odom has had it for so long, then 0."""
        publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        odometry = self.received["/odom"]
        before = len(odometry)

        def is_driven() -> bool:
            publisher.publish(twist)
            self.spin(0.05)
            new_pose = [each for each in odometry[before:] if each.twist.twist == twist]
            return len(new_pose) * ODOMETRY_S >= seconds

        self.spin_until(is_driven)
        publisher.publish(Twist())
        self.spin_until(lambda: odometry[-1].twist.twist == Twist())


@pytest.fixture
def robot(webviz_domain: int) -> Iterator[RobotClient]:
    context = Context()
    context.init(domain_id=webviz_domain)
    node = RobotClient(context)
    yield node
    node.executor_.shutdown()
    node.destroy_node()
    context.try_shutdown()


def nanoseconds(stamp: Any) -> int:
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def planar(pose: Any) -> Pose2D:
    yaw = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
    return Pose2D(pose.position.x, pose.position.y, yaw)


def period(messages: Sequence[Any]) -> float:
    """The usual time between stamps in seconds; a busy machine may lose single messages."""
    return np.median(np.diff([nanoseconds(m.header.stamp) for m in messages])) * 1e-9


def twist(linear: float, angular: float) -> Twist:
    message = Twist()
    message.linear.x, message.angular.z = linear, angular
    return message


def test_it_publishes_the_topics_of_a_turtlebot_with_nav2(
    sim: Simulators, robot: RobotClient
) -> None:
    sim("scan_beams:=180", "seed:=7")
    robot.listen_tf()
    odometry = robot.listen("/odom", Odometry)
    scans = robot.listen("/scan", LaserScan, qos_profile_sensor_data)
    joints = robot.listen("/joint_states", JointState)
    maps = robot.listen("/map", OccupancyGrid, LATCHED)
    descriptions = robot.listen("/robot_description", String, LATCHED)
    robot.spin_until(lambda: len(scans) > 30 and maps and descriptions)

    names = dict(robot.get_topic_names_and_types())
    assert {topic: names.get(topic) for topic in TOPICS} == {t: [k] for t, k in TOPICS.items()}
    for topic in TOPICS:
        [info] = robot.get_publishers_info_by_topic(topic)
        latched = info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        reliable = info.qos_profile.reliability == ReliabilityPolicy.RELIABLE
        assert latched == (topic in ("/tf_static", "/map", "/robot_description")), topic
        assert reliable == (topic != "/scan"), topic
    assert "/clock" not in names

    assert period(scans) == pytest.approx(0.1, abs=0.001)
    assert period(odometry) == pytest.approx(0.02, abs=0.001)
    assert period(joints) == pytest.approx(0.05, abs=0.011)  # in steps of the odometry's period
    assert abs(nanoseconds(odometry[-1].header.stamp) - time.time_ns()) < 5e9

    links = {(parent, child) for _, parent, child, _ in robot.transforms()}
    wheels = {("base_link", "wheel_left_link"), ("base_link", "wheel_right_link")}
    assert links == {("map", "odom"), ("odom", "base_link"), *wheels}
    fixed = {(parent, child) for _, parent, child, _ in robot.transforms("/tf_static")}
    links = ("base_footprint", "caster_back_link", "base_scan")
    assert fixed == {("base_link", link) for link in links}
    assert "package://webviz_urdf/demo/meshes/body.stl" in descriptions[0].data
    assert joints[-1].name == ["wheel_left_joint", "wheel_right_joint"]

    world = load_world(BUILDING)
    grid = maps[0]
    assert (grid.info.height, grid.info.width) == world.cells.shape
    assert np.array_equal(np.array(grid.data).reshape(world.cells.shape), world.cells)
    assert grid.header.frame_id == "map"


def test_a_scan_placed_by_tf_at_its_stamp_lies_on_the_walls_of_the_map(
    sim: Simulators, robot: RobotClient
) -> None:
    sim("scan_noise:=0.0", "odom_drift:=0.05")
    robot.listen_tf()
    scans = robot.listen("/scan", LaserScan, qos_profile_sensor_data)
    odometry = robot.listen("/odom", Odometry, 100)
    robot.spin_until(lambda: len(scans) > 30 and abs(robot.pose().x) > 0.5)
    robot.spin(0.5)

    chosen = scans[-10]
    stamp = nanoseconds(chosen.header.stamp)
    moving = robot.transforms()
    [odom_from_base] = [t for s, _, child, t in moving if child == "base_link" and s == stamp]
    assert stamp in {nanoseconds(message.header.stamp) for message in odometry}
    dated_ahead = stamp + 200_000_000
    [map_from_odom] = [t for s, _, child, t in moving if child == "odom" and s == dated_ahead]
    fixed = robot.transforms("/tf_static")
    [base_from_scan] = [t for _, _, child, t in fixed if child == "base_scan"]

    def as_pose(transform: Any) -> Pose2D:
        rotation, shift = transform.rotation, transform.translation
        return Pose2D(shift.x, shift.y, 2.0 * math.atan2(rotation.z, rotation.w))

    scanner = as_pose(map_from_odom) @ as_pose(odom_from_base) @ as_pose(base_from_scan)
    world = load_world(BUILDING)
    x, y, yaw = world.to_grid(scanner)
    angles = yaw + chosen.angle_min + chosen.angle_increment * np.arange(len(chosen.ranges))
    count = len(angles)
    expected, _ = cast_rays(world.occupied, np.full(count, x), np.full(count, y), angles, 200.0)
    ranges = np.array(chosen.ranges)
    agree = np.isclose(ranges, expected * world.resolution, atol=0.01)
    assert agree.mean() > 0.95  # rounding turns a few beams past an edge


def test_commands_move_it_by_the_commanded_amount_and_no_farther(
    sim: Simulators, robot: RobotClient
) -> None:
    sim("tour:=false", "start_pose:=[0.0, 0.0, 0.0]")
    odometry = robot.listen("/odom", Odometry, 1000)
    robot.spin_until(lambda: odometry)
    assert robot.pose() == pytest.approx(Pose2D())
    robot.drive(twist(0.3, 0.0), 2.0)
    new_pose = robot.pose()
    driving = [message for message in odometry if message.twist.twist.linear.x == 0.3]
    # As long as the command lasted, which is longer than 2 s where the sender is slow.
    assert new_pose == pytest.approx((0.3 * ODOMETRY_S * len(driving), 0.0, 0.0))
    assert new_pose.x > 0.59
    robot.spin(0.5)
    assert robot.pose() == new_pose
    robot.drive(twist(0.0, 0.5), 2.0)
    turning = [message for message in odometry if message.twist.twist.angular.z == 0.5]
    assert robot.pose() == pytest.approx((new_pose.x, 0.0, 0.5 * ODOMETRY_S * len(turning)))
    assert robot.pose().yaw > 0.99


def test_a_stale_command_stops_it(sim: Simulators, robot: RobotClient) -> None:
    sim("tour:=false", "stamped_cmd_vel:=true", "start_pose:=[0.0, 0.0, 0.0]")
    odometry = robot.listen("/odom", Odometry, 1000)  # as long as this process has to wait
    publisher = robot.create_publisher(TwistStamped, "/cmd_vel", 10)
    robot.spin_until(lambda: odometry and publisher.get_subscription_count() > 0)
    publisher.publish(TwistStamped(twist=twist(0.4, 0.0)))
    robot.spin_until(lambda: any(each.twist.twist.linear.x > 0 for each in odometry))
    robot.spin_until(lambda: odometry[-1].twist.twist.linear.x == 0)
    assert robot.pose().x == pytest.approx(0.4 * 0.5, abs=0.02)


def test_resetting_the_odometry_moves_odom_and_not_the_robot(
    sim: Simulators, robot: RobotClient
) -> None:
    sim("tour:=false", "start_pose:=[1.0, 0.0, 0.0]")
    robot.listen_tf()
    odometry = robot.listen("/odom", Odometry)
    robot.spin_until(lambda: odometry)
    robot.drive(twist(0.4, 0.0), 1.0)
    before = robot.pose()
    client = robot.create_client(Empty, "/reset_odom")
    response_of(client, Empty.Request(), robot.executor_)
    robot.spin(0.5)
    assert robot.pose() == pytest.approx(Pose2D())
    correction = [t for _, _, child, t in robot.transforms() if child == "odom"][-1]
    assert correction.translation.x == pytest.approx(1.0 + before.x)


def test_an_initial_pose_puts_the_robot_there_in_the_map(
    sim: Simulators, robot: RobotClient
) -> None:
    sim("tour:=false")
    robot.listen_tf()
    odometry = robot.listen("/odom", Odometry)
    publisher = robot.create_publisher(PoseWithCovarianceStamped, "/initialpose", 10)
    robot.spin_until(lambda: odometry and publisher.get_subscription_count() > 0)
    message = PoseWithCovarianceStamped()
    message.header.frame_id = "map"
    message.pose.pose.position.x, message.pose.pose.position.y = -4.5, 1.5
    publisher.publish(message)

    def corrected() -> bool:
        results = [t for _, _, child, t in robot.transforms() if child == "odom"]
        return bool(results) and results[-1].translation.x == pytest.approx(-4.5)

    robot.spin_until(corrected)
    assert robot.pose() == pytest.approx(Pose2D())


def test_a_goal_is_planned_and_reached_and_a_bad_one_is_reported(
    sim: Simulators, robot: RobotClient
) -> None:
    process = sim("tour:=false", "tour_speed:=0.6", "start_pose:=[0.0, 0.0, 0.0]")
    odometry = robot.listen("/odom", Odometry)
    kind = message_class("nav_msgs/msg/Path")
    paths = robot.listen("/path", kind)
    publisher = robot.create_publisher(PoseStamped, "/goal_pose", 10)
    robot.spin_until(lambda: odometry and publisher.get_subscription_count() > 0)
    goal = PoseStamped()
    goal.pose.position.x = 1.2
    goal.header.frame_id = "nowhere"
    publisher.publish(goal)
    goal.header.frame_id = "map"
    publisher.publish(goal)
    robot.spin_until(lambda: paths)
    last = paths[0].poses[-1].pose.position
    assert (last.x, last.y) == pytest.approx((1.2, 0.0))
    robot.spin_until(lambda: abs(robot.pose().x - 1.2) < 0.15)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert "Ignored a /goal_pose in the frame 'nowhere': send it in map." in errors


def test_parameters_change_while_it_runs_and_bad_ones_are_refused(
    sim: Simulators, robot: RobotClient
) -> None:
    from rcl_interfaces.srv import DescribeParameters, SetParameters
    from rclpy.parameter import Parameter

    sim("tour:=false")
    scans = robot.listen("/scan", LaserScan, qos_profile_sensor_data)
    client = robot.create_client(SetParameters, "/sim/set_parameters")
    robot.spin_until(lambda: scans)

    def set_parameter(name: str, value: Any) -> tuple[bool, str]:
        parameter = Parameter(name, value=value).to_parameter_msg()
        request = SetParameters.Request(parameters=[parameter])
        [result] = response_of(client, request, robot.executor_).results
        return result.successful, result.reason

    describing = robot.create_client(DescribeParameters, "/sim/describe_parameters")
    names = [*OPTIONS, "use_sim_time"]
    request = DescribeParameters.Request(names=names)
    descriptors = response_of(describing, request, robot.executor_).descriptors
    assert all(each.description for each in descriptors)

    assert set_parameter("scan_beams", 90) == (True, "")
    robot.spin_until(lambda: len(scans[-1].ranges) == 90)
    # rclpy checks the ranges that are declared.
    is_done, reason = set_parameter("scan_rate", -1.0)
    assert not is_done
    assert reason.startswith("Parameter scan_rate out of range Min: 0.1, Max: 100.0, value: -1.0")
    # A whole number is as good, and checked as well.
    assert set_parameter("scan_rate", 8) == (True, "")
    assert set_parameter("scan_rate", -1) == (
        False,
        "scan_rate must be between 0.1 and 100, not -1.",
    )
    assert set_parameter("tour", "often") == (False, "tour must be true or false, not 'often'.")
    range_min = "scan_range_min must be below scan_range_max, which is 10.0."
    assert set_parameter("scan_range_min", 20.0) == (False, range_min)
    assert not set_parameter("seed", 3)[0]
    robot.spin(0.3)
    assert len(scans[-1].ranges) == 90


def test_a_clock_of_its_own_starts_at_zero_and_stamps_everything(
    sim: Simulators, robot: RobotClient
) -> None:
    sim("publish_clock:=true", "scan_sweep:=true")
    clocks = robot.listen("/clock", Clock, 1000)  # none is lost while this process has to wait
    scans = robot.listen("/scan", LaserScan, qos_profile_sensor_data)
    robot.spin_until(lambda: len(scans) > 5 and clocks)
    assert nanoseconds(clocks[-1].clock) < 60e9
    assert nanoseconds(scans[-1].header.stamp) < 60e9
    assert scans[-1].time_increment == pytest.approx(0.1 / 360)
    stamps = [nanoseconds(clock.clock) for clock in clocks]
    assert set(np.diff(stamps)) == {20_000_000}


def test_sigterm_ends_it_with_status_0(sim: Simulators, robot: RobotClient) -> None:
    process = sim()
    odometry = robot.listen("/odom", Odometry)
    robot.spin_until(lambda: odometry)
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=60)
    assert process.returncode == 0


@pytest.fixture
def refusal_of(capfd: pytest.CaptureFixture[str]) -> Iterator[Refusals]:
    """Run the simulator in this process, where it must not start."""
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}

    def refusal_of(*args: str) -> tuple[object, str, str]:
        try:
            status: object = main([*args])
        except SystemExit as exit:
            status = exit.code
        printed = capfd.readouterr()
        assert "Traceback" not in printed.err
        return status, printed.out, printed.err

    yield refusal_of
    for number, handler in handlers.items():
        signal.signal(number, handler)


def test_a_params_file_sets_parameters(refusal_of: Refusals, tmp_path: Path) -> None:
    path = tmp_path / "params.yaml"
    path.write_text("/sim:\n  ros__parameters:\n    scan_rate: 3\n    scan_beams: 0\n")
    status, _, errors = refusal_of("--ros-args", "--params-file", str(path))
    assert status == 1
    refusal = "Invalid parameter: Parameter scan_beams out of range. Min: 1, Max: 20000, value: 0"
    assert refusal in errors


@pytest.mark.parametrize(
    ("args", "status", "sentence"),
    [
        (["--ros-args", "-p", "world:=none.yaml"], 1, "Cannot read the map none.yaml: No such"),
        (["--ros-args", "-p", "rate:=fast"], 1, "rate must be a number, not 'fast'."),
        (["--ros-args", "-p", "start_pose:=[1.0]"], 1, "start_pose must be [x, y, yaw] or []"),
        (["--ros-args", "--nonsense"], 1, "ROS does not start (UnknownROSArgsError)"),
        (["--nonsense"], 2, "unrecognized arguments: --nonsense"),
        (["--fault", "foo=1"], 2, "Unknown fault 'foo'. Choose one of laser_yaw, misplaced"),
        (["--fault", "clock=late"], 2, "clock must be a number, not 'late'"),
        (["--fault", "laser_yaw=9"], 2, "laser_yaw must be between -3.14159 and 3.14159"),
    ],
)
def test_wrong_arguments_end_in_one_sentence(
    refusal_of: Refusals, args: list[str], status: int, sentence: str
) -> None:
    ended, _, errors = refusal_of(*args)
    assert ended == status
    assert sentence in errors


def test_help_lists_the_parameters(refusal_of: Refusals) -> None:
    status, output, _ = refusal_of("--help")
    assert status == 0
    assert "stamped_cmd_vel" in output


def test_a_missing_rclpy_is_explained(
    refusal_of: Refusals, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "rclpy", None)
    status, _, errors = refusal_of()
    assert status == 1
    assert errors.count("\n") == 1
    assert 'pip install "ros-webviz[ros]"' in errors
