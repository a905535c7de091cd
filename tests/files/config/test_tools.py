"""The list of tools of a config file."""

from __future__ import annotations

import pytest

from webviz.api.tool import Tool, outputs
from webviz.files.config import Config, ConfigError, Unreadable, document, dump
from webviz.files.opening import parse

INSTALLED = "version: 1\ndisplays: []\n"


def test_without_a_list_there_are_all_installed_tools_and_none_is_written() -> None:
    config = parse(INSTALLED, "x.yaml")
    tools = [tool for tool in config.tools if isinstance(tool, Tool)]
    assert [(tool.name, topic.name) for tool in tools for _, _, topic in outputs(tool)] == [
        ("2D Pose Estimate", "/initialpose"),
        ("2D Goal Pose", "/goal_pose"),
        ("Publish Point", "/clicked_point"),
        ("Teleop", "/cmd_vel"),
    ]
    assert dump(config) == INSTALLED


def test_an_empty_list_is_kept() -> None:
    config = parse("displays: []\ntools:\n", "x.yaml")
    assert config.tools == []
    assert document(config)["tools"] == []


def test_tools_of_a_file_are_written_again() -> None:
    text = (
        f"{INSTALLED}tools:\n"
        "- {type: GoalPose, name: Go, topic: /go}\n"
        "- type: GoalPose\n  topic: {name: /slow, reliability: best_effort}\n"
    )
    config = parse(text, "x.yaml")
    assert document(parse(dump(config), "x.yaml")) == document(config)
    assert [tool.name for tool in config.tools] == ["Go", "2D Goal Pose"]


@pytest.mark.parametrize(
    ("entry", "reason"),
    [
        ("{type: GoalPos}", "tools[0].type: unknown tool type `GoalPos`, did you mean `GoalPose`?"),
        ("{type: Grid}", "tools[0].type: unknown tool type `Grid`, "),
        ("5", "tools[0]: a tool needs a `type`, such as `type: GoalPose`."),
        ("{type: GoalPose, topic: 5}", "tools[0].topic: expected the name of a topic, got 5."),
        ("{type: GoalPose, topics: /a}", "tools[0].topics: unknown key, did you mean `topic`?"),
    ],
)
def test_a_mistake_names_its_line_and_key_and_keeps_the_entry(entry: str, reason: str) -> None:
    config = parse(f"displays: []\ntools:\n- {entry}\n", "x.yaml")
    (tool,) = config.tools
    assert isinstance(tool, Unreadable)
    assert tool.reason.startswith(f"x.yaml:3: {reason}")
    assert document(config)["tools"] == [tool.values]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("tools: 5", "x.yaml:1: tools: expected a list, each entry with a `type`."),
        ("tools: [" + "x, " * 101 + "]", "x.yaml has 101 tools; the limit is 100."),
    ],
)
def test_an_invalid_list_of_tools_is_refused(text: str, reason: str) -> None:
    with pytest.raises(ConfigError) as excinfo:
        parse(text, "x.yaml")
    assert str(excinfo.value) == reason


def test_each_config_has_tools_of_its_own() -> None:
    assert Config().tools[0] is not Config().tools[0]
