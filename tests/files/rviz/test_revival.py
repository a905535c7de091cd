"""Revival of kept `.rviz` entries once their display is available."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Annotated, Any

import pytest
from rviz_trees import differences, texts

from webviz.api import registry
from webviz.api.declared import Topic
from webviz.api.display import Display
from webviz.api.ports import Input
from webviz.files import rviz
from webviz.files.config import Branch, Unreadable, dump
from webviz.files.opening import parse

TEXT = """\
Visualization Manager:
  Displays:
    - Class: rviz_common/Group
      Name: Sensors
      Enabled: true
      Displays:
        - Class: rviz_plugins/Sonar
          Name: Front
          Enabled: true
          Beam Count: 7
          Glow: 1
          Topic: {Value: /front, Depth: 5}
    - Class: rviz_plugins/Sonar
      Name: Twin
      Value: true
      Beam Count: many
      Glow: 2
    - Class: rviz_plugins/Sonar
      Name: Twin
      Value: true
    - Class: rviz_plugins/Radar
      Name: Radar
"""


class Sonar(Display):
    """Beams of sound."""

    rviz = "rviz_plugins/Sonar"

    topic: Annotated[Topic, Input("sensor_msgs/msg/Range")] = Topic("/sonar")
    beam_count: int = 3


@pytest.fixture
def install() -> Iterator[Callable[[], None]]:
    """Make the display known."""
    yield lambda: registry.register("test", {"Sonar": Sonar})
    registry.register("test", {})


def test_kept_displays_are_read_once_their_type_is_there(install: Callable[[], None]) -> None:
    yaml_text = dump(rviz.read(TEXT, "x.rviz")[0])
    before = parse(yaml_text, "x.yaml")
    group: Any = before.displays[0]
    assert isinstance(group.displays[0], Unreadable)
    assert before.report == []
    install()
    after = parse(yaml_text, "x.yaml")
    branch, twin, other, radar = after.displays
    assert isinstance(branch, Branch)
    (front,) = branch.displays
    assert isinstance(front, Sonar)
    assert (front.name, front.topic.name, front.beam_count) == ("Front", "/front", 7)
    assert isinstance(twin, Sonar)
    assert isinstance(other, Sonar)
    assert twin.beam_count == 3
    assert isinstance(radar, Unreadable)
    assert "Twin: Beam Count: expected a number, got `many`; using the default." in after.report
    assert "Front, Twin: Glow: unsupported" in "\n".join(after.report)


def test_no_key_is_lost_by_coming_alive(install: Callable[[], None]) -> None:
    yaml_text = dump(rviz.read(TEXT, "x.rviz")[0])
    install()
    config = parse(dump(parse(yaml_text, "x.yaml")), "x.yaml")
    text = rviz.write(config)[0]
    assert list(differences(texts(TEXT), texts(text))) == []
    assert [each["Glow"] for each in texts(text)["Visualization Manager"]["Displays"][1:2]] == ["2"]
