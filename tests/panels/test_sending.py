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
    panel_view = on_topics(PublishMessage(topic="/goal_pose"))
    reader = Endpoint("/planner", POSE, "reliable", "volatile")
    offers = {"/goal_pose": Offer((), readers=(reader,))}
    show_panel(panel_view.panel, State(topics={"/goal_pose": ()}, offers=offers))
    values = panel_view.ui.widgets["0"].values["values"]
    assert (values["about"], values["names"]) == (POSE, ["/goal_pose"])


def test_a_form_is_made_from_the_definition_and_follows_the_yaml() -> None:
    panel_view = on_topics(PublishMessage(topic="/goal"))
    assert panel_view.values()["about"] == POSE
    assert panel_view.values()["fields"][3] == {"path": "pose.position.x", "text": "0.0"}
    panel_view.panel.use({"field": ["pose.position.x", "1.5"]}, 1)
    panel_view.panel.use({"field": ["header.frame_id", "true"]}, 1)
    assert "x: 1.5" in panel_view.values()["yaml"]
    assert 'frame_id: "true"' in panel_view.values()["yaml"]
    panel_view.panel.use({}, 1)
    (publish,) = panel_view.commands
    assert isinstance(publish, Publish)
    assert publish.values["pose"]["position"]["x"] == 1.5
    assert panel_view.values()["history"] == [panel_view.values()["yaml"]]
    panel_view.panel.use({"reset": True}, 1)
    assert "x: 0.0" in panel_view.values()["yaml"]


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
    panel_view = on_topics(PublishMessage(topic="/name"))
    panel_view.panel.use({"yaml": yaml}, 1)
    assert reason in panel_view.values()["problem"]
    assert panel_view.values()["yaml"] == yaml
    with pytest.raises(Error):
        panel_view.panel.use({}, 1)
    with pytest.raises(Error):
        panel_view.panel.use({"repeat": True}, 1)
    assert panel_view.commands == []


def test_a_field_that_does_not_fit_is_corrected_in_the_form() -> None:
    panel_view = on_topics(ServiceCall(service="/light", service_type="std_srvs/srv/SetBool"))
    panel_view.panel.use({"field": ["data", "maybe"]}, 1)
    assert "expected bool" in panel_view.values()["problem"]
    panel_view.panel.use({"field": ["data", "true"]}, 1)
    assert (panel_view.values()["problem"], panel_view.values()["yaml"]) == ("", "data: true\n")


def test_presets_are_properties_and_history_is_bounded() -> None:
    panel_view = on_topics(PublishMessage(topic="/name", presets={"hello": "data: hello"}))
    panel_view.panel.use({"preset": "hello"}, 1)
    assert panel_view.values()["fields"] == [{"path": "data", "text": "hello"}]
    panel_view.panel.use({"keep": "again"}, 1)
    presets = {"hello": "data: hello", "again": "data: hello"}
    assert panel_view.commands.pop() == SetPanelProperty("id", "presets", presets)
    panel_view.panel.presets = {str(i): "" for i in range(MAX_PRESETS)}
    for key in ("more", " "):
        with pytest.raises(Error):
            panel_view.panel.use({"keep": key}, 1)
    for i in range(3 * HISTORY):
        panel_view.panel.use({"yaml": f"data: '{i}'"}, 1)
        panel_view.panel.use({}, 1)
    assert len(panel_view.values()["history"]) == HISTORY


def test_a_message_repeats_until_stopped_or_no_page_shows_the_panel(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    panel_view = on_topics(PublishMessage(topic="/name", rate=0.001))
    panel_view.panel.use({"repeat": True}, 1)
    for _ in range(5):
        assert panel_view.values()["repeats"]
    assert [type(each) for each in panel_view.commands] == [Publish]
    monkeypatch.setattr("webviz.panels.publish.PAUSE_S", -1.0)
    assert not panel_view.values()["repeats"]


def test_a_refused_message_is_not_repeated_and_its_reason_goes_with_the_next_edit() -> None:
    panel_view = on_topics(PublishMessage(topic="/name"))
    panel_view.panel.use({"repeat": True}, 1)
    panel_view.values()
    panel_view.commands[0].report(Status(Level.ERROR, "Not allowed."))
    values = panel_view.values()
    assert (values["outcome"], values["failed"], values["repeats"]) == ("Not allowed.", True, False)
    panel_view.panel.use({"yaml": "data: again"}, 1)
    assert (panel_view.values()["outcome"], panel_view.values()["failed"]) == ("", False)


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
