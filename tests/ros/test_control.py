"""Parameters and services of a viewer, used by real clients over DDS."""

from __future__ import annotations

import logging
import os
import re
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from diagnostic_msgs.srv import SelfTest
from nodes import SpunNode
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from several import several
from std_msgs.msg import Int32
from std_srvs.srv import Empty, Trigger

import webviz
from webviz.api.declared import Topic
from webviz.api.status import Level, OtherFixedFrame
from webviz.data.messages import decode, encode
from webviz.engine.commands import Command
from webviz.files.config import Settings
from webviz.ros.node import RosSource
from webviz.ros.types import message_class
from webviz.shell.testing.messages import stamped_transform
from webviz.sources import Subscription

TF = "tf2_msgs/msg/TFMessage"
CONFIG = "fixed_frame: odom\ndisplays: [{type: Grid, name: Floor}]\n"
VIEWS = """\
view: {distance: 3.0}
views:
  Above: {type: TopDownOrtho, scale: 20.0}
  Close: {distance: 1.0}
displays: []
"""
Viewers = Callable[..., webviz.Viewer]


class Client(SpunNode):
    """The node of another program."""

    def __init__(self, domain: int) -> None:
        super().__init__(domain, "client")
        self._parameters = AsyncParameterClient(self.node, "webviz")

    def wait(self, future: Future, seconds: float = 60.0) -> Any:
        self.executor.spin_until_future_complete(future, timeout_sec=seconds)
        assert future.done(), f"no answer within {seconds} s"
        return future.result()

    def get(self, name: str) -> str:
        assert self._parameters.wait_for_services(60.0)
        return self.wait(self._parameters.get_parameters([name])).values[0].string_value

    def describe(self, names: list[str]) -> dict[str, str]:
        assert self._parameters.wait_for_services(60.0)
        answer = self.wait(self._parameters.describe_parameters(names))
        return {each.name: each.description for each in answer.descriptors}

    def set(self, name: str, value: object) -> str:
        """Set a parameter, and return why not, "" if it is set."""
        assert self._parameters.wait_for_services(60.0)
        answer = self._parameters.set_parameters([Parameter(name, value=value)])
        result = self.wait(answer).results[0]
        assert result.successful == (not result.reason)
        return result.reason

    def ask(self, service: str, type: Any = Trigger) -> Future:
        client = self.node.create_client(type, service)
        assert client.wait_for_service(60.0)
        return client.call_async(type.Request())

    def call(self, service: str, type: Any = Trigger) -> Any:
        return self.wait(self.ask(service, type))

    def publish_frames(self, *frames: str) -> None:
        """Frames below `map`."""
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        transforms = [stamped_transform("map", frame, 0) for frame in frames]
        publisher = self.node.create_publisher(message_class(TF), "/tf_static", qos)
        publisher.publish(encode(TF, {"transforms": transforms}))


@pytest.fixture
def client(webviz_domain: int) -> Iterator[Client]:
    client = Client(webviz_domain)
    yield client
    client.close()


@pytest.fixture
def open_viewer(webviz_domain: int) -> Iterator[Viewers]:
    """Begins a viewer on ROS; arguments by name are those of `webviz.Viewer`."""

    def open_viewer(
        config: Path | None = None, parameters: Sequence[str] = (), **options: Any
    ) -> webviz.Viewer:
        ros_args = ["--ros-args", *(word for parameter in parameters for word in ("-p", parameter))]
        return webviz.Viewer(config, port=0, ros_args=ros_args, **options)

    with several(open_viewer) as viewers:
        yield viewers


@pytest.fixture
def config(tmp_path: Path) -> Path:
    path = tmp_path / "floor.yaml"
    path.write_text(CONFIG)
    return path


def test_parameters_follow_the_state_of_the_viewer(
    open_viewer: Viewers, client: Client, config: Path
) -> None:
    viewer = open_viewer()
    client.until(lambda: client.get("fixed_frame") == "map", "the parameter has the frame")
    assert client.get("config_file") == ""
    viewer.fixed_frame = "base"
    client.until(lambda: client.get("fixed_frame") == "base", "the parameter has the new frame")
    viewer.open(config)
    client.until(lambda: client.get("config_file") == str(config), "the parameter has the file")
    assert client.get("fixed_frame") == "odom"


def test_every_parameter_of_the_viewer_is_described(open_viewer: Viewers, client: Client) -> None:
    open_viewer()
    described = client.describe(["config_file", "fixed_frame", "view", "use_sim_time"])
    assert all(described.values()), described


def test_parameters_given_at_the_start_choose_file_and_frame(
    open_viewer: Viewers, client: Client, config: Path
) -> None:
    viewer = open_viewer(parameters=[f"config_file:={config}"])
    assert (viewer.path, viewer.fixed_frame) == (str(config), "odom")
    assert "Floor" in viewer
    assert client.get("config_file") == str(config)


def test_the_command_line_is_stronger_than_parameters_and_they_than_the_file(
    open_viewer: Viewers, config: Path, tmp_path: Path
) -> None:
    other = tmp_path / "other.yaml"
    other.write_text("displays: []")
    parameters = ["fixed_frame:=base", f"config_file:={config}"]
    viewer = open_viewer(parameters=parameters)
    assert (viewer.path, viewer.fixed_frame) == (str(config), "base")
    viewer = open_viewer(other, parameters, fixed_frame="odom")
    assert (viewer.path, viewer.fixed_frame) == (str(other), "odom")


def test_a_file_at_the_start_that_is_missing_is_refused(open_viewer: Viewers) -> None:
    with pytest.raises(webviz.Error, match=r"^Cannot read /nowhere.yaml: No such file"):
        open_viewer(parameters=["config_file:=/nowhere.yaml"])


def test_any_fixed_frame_is_accepted_and_a_missing_one_reported(
    open_viewer: Viewers, client: Client
) -> None:
    viewer = open_viewer()
    client.publish_frames("base_link", "laser")
    client.until(lambda: "laser" in viewer.frames, "the frames are known")

    def by_ros(frame: str) -> None:
        assert client.set("fixed_frame", frame) == ""

    def by_python(frame: str) -> None:
        viewer.fixed_frame = frame

    for choose in (by_ros, by_python):
        choose("/base_link")
        assert viewer.fixed_frame == "base_link"
        assert viewer.statuses["Fixed Frame"].level is Level.OK
        choose("base_lnk")
        assert viewer.fixed_frame == "base_lnk"
        client.until(lambda: client.get("fixed_frame") == "base_lnk", "the parameter")
        status = viewer.statuses["Fixed Frame"]
        assert (status.level, status.remedy) == (Level.ERROR, OtherFixedFrame("base_link"))
        assert status.text == 'Fixed frame "base_lnk" does not exist. Did you mean "base_link"?'
    assert client.set("fixed_frame", "/") == "The fixed frame needs a name."
    with pytest.raises(webviz.Error, match=r"^The fixed frame needs a name\.$"):
        viewer.fixed_frame = ""
    # rclpy of Jazzy names the type, that of Kilted its number.
    assert re.search("STRING|expected '4'", client.set("fixed_frame", 5))


def test_another_config_is_opened_by_a_parameter(
    open_viewer: Viewers, client: Client, config: Path, tmp_path: Path
) -> None:
    other = tmp_path / "other.yaml"
    other.write_text("displays: []")
    viewer = open_viewer(config)
    assert client.set("config_file", str(other)) == ""
    assert len(viewer) == 0
    assert client.set("config_file", "floor.yaml") == ""
    assert [display.name for display in viewer] == ["Floor"]
    reason = client.set("config_file", "nowhere.yaml")
    assert reason == f"Cannot read {tmp_path}/nowhere.yaml: No such file or directory."
    os.mkfifo(tmp_path / "fifo.yaml")
    reason = client.set("config_file", "fifo.yaml")
    assert reason == f"Cannot read {tmp_path}/fifo.yaml: it is not a regular file."
    assert client.get("config_file") == str(config)
    assert client.set("config_file", "") != ""


def test_only_configs_of_its_folder_and_of_those_allowed_are_opened_by_a_parameter(
    open_viewer: Viewers, client: Client, config: Path, tmp_path: Path
) -> None:
    for name in ("allowed/deep/a.yaml", "below/b.yaml", "secret.txt", "allowed/secret.txt"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("displays: []")
    viewer = open_viewer(config, config_folders=[tmp_path / "allowed"])
    for outside in (
        "/etc/shadow",
        "../floor.yaml",
        "below/b.yaml",
        "allowed/../below/b.yaml",
        f"{tmp_path}/allowed/deep/../../../x.yaml",
    ):
        reason = client.set("config_file", outside)
        assert "is outside" in reason
        assert "--config-folder" in reason
    for other in ("secret.txt", "allowed/secret.txt"):
        assert "Its name must end with .yaml or .rviz" in client.set("config_file", other)
    assert viewer.path == str(config)
    assert client.set("config_file", "allowed/deep/a.yaml") == ""
    assert viewer.path == str(tmp_path / "allowed/deep/a.yaml")
    assert client.call("/webviz/load_config").success


def test_parameters_of_ros_itself_go_on(open_viewer: Viewers, client: Client) -> None:
    open_viewer(parameters=["use_sim_time:=true"])
    assert client.set("use_sim_time", False) == ""


def test_a_config_is_loaded_again_and_saved_by_services(
    open_viewer: Viewers, client: Client, config: Path
) -> None:
    viewer = open_viewer(config)
    viewer["Floor"].cell_size = 4.0
    answer = client.call("/webviz/load_config")
    assert (answer.success, answer.message) == (True, f"Opened {config}.")
    assert viewer["Floor"].cell_size == 1.0
    viewer["Floor"].cell_size = 5.0
    answer = client.call("/webviz/save_config")
    assert (answer.success, answer.message) == (True, f"Saved {config}.")
    assert "cell_size: 5.0" in config.read_text()


def test_services_without_a_file_name_the_remedy(open_viewer: Viewers, client: Client) -> None:
    open_viewer()
    for name in ("load_config", "save_config"):
        answer = client.call(f"/webviz/{name}")
        assert not answer.success
        assert "config_file" in answer.message or "Save it on the page" in answer.message


def test_services_record_and_save_the_last_seconds(
    open_viewer: Viewers,
    client: Client,
    config: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(config.parent)
    viewer = open_viewer(config)
    answer = client.call("/webviz/start_recording")
    assert answer.success, answer.message
    recording = viewer.state.recording
    assert recording is not None
    assert answer.message == f"Recording to {recording.path.name}."
    answer = client.call("/webviz/stop_recording")
    assert answer.success, answer.message
    answer = client.call("/webviz/stop_recording")
    assert (answer.success, answer.message) == (False, "Nothing is being recorded.")
    answer = client.call("/webviz/save_last")
    assert not answer.success
    assert answer.message.startswith("No messages are kept in memory.")


@pytest.mark.parametrize(("name", "type"), [("reset", Trigger), ("reset_time", Empty)])
def test_a_reset_forgets_messages(
    open_viewer: Viewers, client: Client, name: str, type: Any
) -> None:
    viewer = open_viewer()
    before = viewer.state.clock.wall_elapsed_s
    client.until(lambda: viewer.state.clock.wall_elapsed_s > before + 1.0, "time goes by")
    client.call(f"/webviz/{name}", type)
    assert viewer.state.clock.wall_elapsed_s < before + 1.0


def test_a_picture_is_written_beside_the_config(
    open_viewer: Viewers, client: Client, config: Path
) -> None:
    open_viewer(config)
    answer = client.wait(client.ask("/webviz/screenshot"), 90.0)
    assert answer.success, answer.message
    (picture,) = config.parent.glob("webviz_screenshot_*.png")
    assert answer.message == f"Saved {picture}."


class SlowViewer:
    """Takes a picture for as long as a test wants."""

    def __init__(self) -> None:
        self.settings, self.path = Settings(), "/somewhere.yaml"
        self.ready = threading.Event()

    def do(self, command: Command) -> str:
        return "Done."

    def fact(self, name: str, otherwise: object = None) -> object:
        return otherwise

    def doctor(self) -> list[webviz.Finding]:
        return []

    last_findings = doctor

    def save_screenshot(self) -> Path:
        assert self.ready.wait(60.0)
        return Path("/picture.png")


@pytest.fixture
def slow(webviz_domain: int) -> Iterator[tuple[SlowViewer, RosSource]]:
    source = RosSource(domain_id=webviz_domain)
    viewer = SlowViewer()
    source.control.open(viewer)
    yield viewer, source
    viewer.ready.set()
    source.close()


def test_messages_arrive_while_a_service_works(
    slow: tuple[SlowViewer, RosSource], client: Client
) -> None:
    viewer, source = slow
    picture = client.ask("/webviz/screenshot")
    source.want({"/count": Subscription("std_msgs/msg/Int32", Topic("/count"))})
    publisher = client.node.create_publisher(Int32, "/count", 5)
    client.until(publisher.get_subscription_count, "the subscription")
    publisher.publish(Int32(data=7))
    numbers: list[int] = []

    def hears() -> list[int]:
        raws = source.inbox.drain().get("/count", ())
        numbers.extend(decode("std_msgs/msg/Int32", raw.cdr).data for raw in raws)
        return numbers

    client.until(hears, "the message arrives")
    assert numbers == [7]
    assert client.get("fixed_frame") == "map"
    assert not picture.done()
    viewer.ready.set()
    assert client.wait(picture).message == "Saved /picture.png."


def test_too_many_requests_are_refused(slow: tuple[SlowViewer, RosSource], client: Client) -> None:
    viewer, _ = slow
    trigger = client.node.create_client(Trigger, "/webviz/screenshot")
    assert trigger.wait_for_service(60.0)
    answers = [trigger.call_async(Trigger.Request()) for _ in range(5)]
    client.until(lambda: any(answer.done() for answer in answers), "one is refused")
    viewer.ready.set()
    messages = [client.wait(answer).message for answer in answers]
    assert messages.count("Too many requests at once. Try again later.") == 1
    assert messages.count("Saved /picture.png.") == 4


def test_before_there_is_a_viewer_parameters_cannot_be_set(
    webviz_domain: int, client: Client
) -> None:
    source = RosSource(domain_id=webviz_domain)
    try:
        assert client.set("fixed_frame", "odom").startswith("The viewer is starting")
    finally:
        source.close()


def test_without_std_srvs_the_rest_works(
    webviz_domain: int,
    client: Client,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    monkeypatch.setitem(sys.modules, "std_srvs.srv", None)
    source = RosSource(domain_id=webviz_domain)
    try:
        with caplog.at_level(logging.WARNING, "webviz"):
            source.control.open(SlowViewer())
            assert client.get("fixed_frame") in ("", "map")
            client.until(lambda: client.get("fixed_frame") == "map", "the parameter has the frame")
        assert "Install ros-jazzy-std-srvs" in caplog.text
    finally:
        source.close()


def test_a_saved_view_is_chosen_by_a_parameter(
    open_viewer: Viewers, client: Client, tmp_path: Path
) -> None:
    path = tmp_path / "views.yaml"
    path.write_text(VIEWS)
    viewer = open_viewer(path, ["view:=Close"])
    assert viewer.view == viewer.views["Close"]
    client.until(lambda: client.get("view") == "Close", "the parameter has the view")
    assert client.set("view", "Above") == ""
    assert viewer.view == viewer.views["Above"]
    assert client.set("view", "Abve") == "Unknown saved view `Abve`: did you mean `Above`?"
    assert client.set("view", "") != ""
    assert client.get("view") == "Above"
    viewer.view = {"distance": 7.0}
    client.until(lambda: client.get("view") == "", "the parameter is empty for an unsaved view")


def test_a_view_at_the_start_that_is_not_saved_is_refused(open_viewer: Viewers) -> None:
    with pytest.raises(webviz.Error, match=r"^Unknown saved view `Above`: none are known$"):
        open_viewer(parameters=["view:=Above"])


def test_the_program_of_the_readme_runs_as_described(
    webviz_domain: int, client: Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    readme = (Path(__file__).parents[2] / "displays/docs/python/README.md").read_text()
    section = readme.partition("## From Python and from ROS")[2]
    program = section.partition("```python\n")[2].partition("```")[0]
    for requested, here in (
        ('"lab.yaml"', '"lab.yaml", port=0'),
        ("viewer.wait()", "values.update(viewer.config)"),
    ):
        assert requested in program
        program = program.replace(requested, here)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lab.yaml").write_text("displays: [{type: Map}]\n")
    values: dict[str, Any] = {}
    exec(program, {"values": values})
    assert values["displays"] == [
        {"type": "Map", "enabled": False},
        {"type": "LaserScan", "topic": "/front/scan", "size": 0.1},
    ]
    assert (tmp_path / "now.png").exists()
    assert "fixed_frame: odom" in (tmp_path / "lab2.yaml").read_text()


def test_without_control_the_node_only_reports(
    open_viewer: Viewers, client: Client, config: Path
) -> None:
    viewer = open_viewer(config, control=False)
    client.until(lambda: client.get("fixed_frame") == "odom", "the parameter has the frame")
    for name, value in (("fixed_frame", "map"), ("config_file", "other.yaml"), ("view", "")):
        assert client.set(name, value).startswith("This viewer was started with --no-control.")
    assert (viewer.fixed_frame, client.get("fixed_frame")) == ("odom", "odom")
    viewer.fixed_frame = "base"
    client.until(lambda: client.get("fixed_frame") == "base", "the parameter has the frame")
    services = [name for name, _ in client.node.get_service_names_and_types()]
    assert "/webviz/get_parameters" in services
    assert not [name for name in services if name.startswith(("/webviz/save", "/webviz/load"))]


def test_findings_are_returned_by_a_service_and_published_on_request(
    open_viewer: Viewers, client: Client, config: Path
) -> None:
    open_viewer(config)  # its fixed frame is not there
    result = client.call("/webviz/doctor", SelfTest)
    assert (result.id, result.passed) == ("/webviz", b"\0")
    assert result.status[0].name == "webviz: doctor"
    assert "webviz: TF001" in {status.name for status in result.status[1:]}

    received: list[DiagnosticArray] = []
    client.node.create_subscription(DiagnosticArray, "/diagnostics", received.append, 1)
    assert client.set("publish_diagnostics", True) == ""
    client.until(lambda: received, "findings are published")
    (whole, *_) = received[-1].status
    assert whole.level == DiagnosticStatus.ERROR
    assert client.set("publish_diagnostics", False) == ""
    client.until(lambda: not client.node.count_publishers("/diagnostics"), "it is over")
