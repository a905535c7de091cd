"""The panels that publish, call and send goals, without a browser."""

from __future__ import annotations

import pytest
from bench import Benches

from tests.support.panel_facts import LonePanel, P
from tests.support.panel_facts import show as show_panel
from webviz.api.errors import Error
from webviz.api.status import Level, Status
from webviz.commands import AddPanel, CallService, OpenPanels, Publish, SendGoal, SetPanelProperty
from webviz.data.messages import encode
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.pipeline.own_names import own_names
from webviz.engine.state import State
from webviz.files.config import Config
from webviz.panels.calling import ActionGoal, ServiceCall
from webviz.panels.publish import PublishMessage
from webviz.panels.sending import HISTORY, MAX_PRESETS, SendingPanel, fields_of, template
from webviz.panels.yaml_text import MAX_CHARACTERS, write_yaml
from webviz.sources import Endpoint, Offer, Publisher

POSE, STRING = "geometry_msgs/msg/PoseStamped", "std_msgs/msg/String"
RELIABLE = ("reliable", "volatile")
TOPICS = {"/goal": (POSE,), "/name": (STRING,)}


def on_topics(panel: P) -> LonePanel[P]:
    """A panel that is open on a viewer with two topics."""
    return LonePanel(panel, topics=TOPICS)


def test_a_topic_that_is_only_read_has_the_type_of_its_subscriptions() -> None:
    opened = on_topics(PublishMessage(topic="/goal_pose"))
    reader = Endpoint("/planner", POSE, "reliable", "volatile")
    offers = {"/goal_pose": Offer((), readers=(reader,))}
    show_panel(opened.panel, State(topics={"/goal_pose": ()}, offers=offers))
    values = opened.ui.widgets["0"].values["values"]
    assert (values["about"], values["names"]) == (POSE, ["/goal_pose"])


def test_a_form_is_made_from_the_definition_and_follows_the_yaml() -> None:
    opened = on_topics(PublishMessage(topic="/goal"))
    assert opened.values()["about"] == POSE
    assert opened.values()["fields"][3] == {"path": "pose.position.x", "text": "0.0"}
    opened.panel.use({"field": ["pose.position.x", "1.5"]}, 1)
    opened.panel.use({"field": ["header.frame_id", "true"]}, 1)
    assert "x: 1.5" in opened.values()["yaml"]
    assert 'frame_id: "true"' in opened.values()["yaml"]
    opened.panel.use({}, 1)
    (publish,) = opened.commands
    assert isinstance(publish, Publish)
    assert publish.values["pose"]["position"]["x"] == 1.5
    assert opened.values()["history"] == [opened.values()["yaml"]]
    opened.panel.use({"reset": True}, 1)
    assert "x: 0.0" in opened.values()["yaml"]


@pytest.mark.parametrize(
    ("yaml", "reason"),
    [
        ("data: 5", "data"),
        ("text: x", "text"),
        ("- 1", "Expected fields with values"),
        ("data: &a [*a]", "Aliases"),
        ("data: [", "not valid YAML"),
        ("x" * (MAX_CHARACTERS + 1), "the limit is"),
    ],
)
def test_an_invalid_message_is_not_sent_and_stays_for_correction(yaml: str, reason: str) -> None:
    opened = on_topics(PublishMessage(topic="/name"))
    opened.panel.use({"yaml": yaml}, 1)
    assert reason in opened.values()["problem"]
    assert opened.values()["yaml"] == yaml
    with pytest.raises(Error):
        opened.panel.use({}, 1)
    with pytest.raises(Error):
        opened.panel.use({"repeat": True}, 1)
    assert opened.commands == []


def test_a_field_that_does_not_fit_is_corrected_in_the_form() -> None:
    opened = on_topics(ServiceCall(service="/light", service_type="std_srvs/srv/SetBool"))
    opened.panel.use({"field": ["data", "maybe"]}, 1)
    assert "expected bool" in opened.values()["problem"]
    opened.panel.use({"field": ["data", "true"]}, 1)
    assert (opened.values()["problem"], opened.values()["yaml"]) == ("", "data: true\n")


def test_presets_are_properties_and_history_is_bounded() -> None:
    opened = on_topics(PublishMessage(topic="/name", presets={"hello": "data: hello"}))
    opened.panel.use({"preset": "hello"}, 1)
    assert opened.values()["fields"] == [{"path": "data", "text": "hello"}]
    opened.panel.use({"keep": "again"}, 1)
    presets = {"hello": "data: hello", "again": "data: hello"}
    assert opened.commands.pop() == SetPanelProperty("id", "presets", presets)
    opened.panel.presets = {str(i): "" for i in range(MAX_PRESETS)}
    for refused in ("more", " "):
        with pytest.raises(Error):
            opened.panel.use({"keep": refused}, 1)
    for i in range(3 * HISTORY):
        opened.panel.use({"yaml": f"data: '{i}'"}, 1)
        opened.panel.use({}, 1)
    assert len(opened.values()["history"]) == HISTORY


def test_a_message_repeats_until_stopped_or_no_page_shows_the_panel(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    opened = on_topics(PublishMessage(topic="/name", rate=0.001))
    opened.panel.use({"repeat": True}, 1)
    for _ in range(5):
        assert opened.values()["repeats"]
    assert [type(each) for each in opened.commands] == [Publish]
    monkeypatch.setattr("webviz.panels.publish.PAUSE_S", -1.0)
    assert not opened.values()["repeats"]


def test_a_refused_message_is_not_repeated_and_its_reason_goes_with_the_next_edit() -> None:
    opened = on_topics(PublishMessage(topic="/name"))
    opened.panel.use({"repeat": True}, 1)
    opened.values()
    opened.commands[0].report(Status(Level.ERROR, "Not allowed."))
    values = opened.values()
    assert (values["outcome"], values["failed"], values["repeats"]) == ("Not allowed.", True, False)
    opened.panel.use({"yaml": "data: again"}, 1)
    assert (opened.values()["outcome"], opened.values()["failed"]) == ("", False)


def test_a_panel_of_the_config_may_publish_also_before_the_type_is_known() -> None:
    panel = PublishMessage(topic="/later")
    assert own_names(Config(panels=[panel]), ErrorBoundary("", strict=True)).count("/later") == 1
    assert "/later" not in own_names(Config(), ErrorBoundary("", strict=True))


def test_a_service_and_an_action_have_forms_of_their_requests() -> None:
    call = on_topics(ServiceCall(service="/light", service_type="std_srvs/srv/SetBool"))
    call.panel.use({"field": ["data", "true"]}, 1)
    call.panel.use({}, 1)
    (call_service,) = call.commands
    assert isinstance(call_service, CallService)
    assert (call_service.service, call_service.request) == ("/light", {"data": True})
    call_service.failed("Nobody answers.")
    assert call.values()["outcome"] == "Nobody answers."
    goal = on_topics(ActionGoal(action="/undock", action_type="nav2_msgs/action/UndockRobot"))
    goal.panel.use({"field": ["max_undocking_time", "1"]}, 1)
    goal.panel.use({}, 1)
    assert isinstance(goal.commands[0], SendGoal)
    state = State(services={"/light": "std_srvs/srv/SetBool", "/a/list_parameters": "x/srv/Y"})
    untyped = on_topics(ServiceCall(service="/light"))
    show_panel(untyped.panel, state)
    values = untyped.ui.widgets["0"].values["values"]
    assert (values["about"], values["names"]) == ("std_srvs/srv/SetBool", ["/light"])
    untyped.panel.use({}, 1)
    assert untyped.commands[0].type == "std_srvs/srv/SetBool"
    unnamed = on_topics(ActionGoal(action="/undock"))
    server = Publisher("/dock", "nav2_msgs/action/UndockRobot_FeedbackMessage", *RELIABLE)
    show_panel(unnamed.panel, State(offers={"/undock/_action/feedback": Offer((server,))}))
    values = unnamed.ui.widgets["0"].values["values"]
    assert (values["about"], values["names"]) == ("nav2_msgs/action/UndockRobot", ["/undock"])
    unnamed.panel.use({}, 1)
    assert unnamed.commands[0].request.type == "nav2_msgs/action/UndockRobot"
    for panel in (
        ServiceCall(service="/such", service_type="no/srv/Such"),
        ActionGoal(action="/such", action_type="no/action/Such"),
    ):
        assert "No definition of no/" in on_topics(panel).values()["about"]
        with pytest.raises(Error, match="message type is unknown"):
            panel.use({}, 1)


@pytest.mark.parametrize("panel", [PublishMessage(topic=""), ServiceCall(), ActionGoal()])
def test_a_panel_without_a_name_asks_for_it(panel: SendingPanel) -> None:
    assert on_topics(panel).values()["about"] == f"Enter the name of the {panel.target}."
    with pytest.raises(Error, match=f"No {panel.target} is chosen"):
        panel.use({}, 1)


@pytest.mark.parametrize(
    "type_", [POSE, "sensor_msgs/msg/CameraInfo", "moveit_msgs/msg/PlanningScene"]
)
def test_the_defaults_of_a_form_can_be_sent(type_: str) -> None:
    values = template(type_)
    assert encode(type_, values) == encode(type_)
    assert len(write_yaml(values)) < MAX_CHARACTERS
    assert fields_of(values)


def test_a_message_without_fields_has_none_in_its_form() -> None:
    assert template("std_msgs/msg/Empty") == {}


def test_nothing_is_published_to_a_read_only_source(bench: Benches) -> None:
    b = bench()
    b.do(AddPanel("PublishMessage", {"topic": "/cmd", "message_type": STRING}))
    b.do(OpenPanels(frozenset({"PublishMessage"})))
    texts: list[str] = []
    b.do(Publish("/cmd", STRING, {}, report=lambda status: texts.append(status.text)))
    assert texts == ["This source can only be read."]
