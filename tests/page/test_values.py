"""Values of messages in the page: as text in a pane."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from webviz.api.declared import Topic
from webviz.api.nodes import Pane
from webviz.api.pictures import Readout
from webviz.data.messages import Header, JointState, String, Time
from webviz.edges.page.pictures import Pictures
from webviz.engine.state import Row, Traffic
from webviz_displays.text import Text

HOSTILE = "<img src=x onerror=alert(1)>"
JOINTS = JointState(Header(Time(5, 0), "base"), ["left", HOSTILE], np.array([0.25, 1e308]))


@pytest.fixture(scope="module")
def pictures(server: Any) -> Pictures:
    return Pictures(server.channel)


@pytest.fixture
def texts(tab: Any, pictures: Pictures) -> Iterator[Any]:
    """The tab with a text of joint states."""
    display = Text(name="Joints", topic=Topic("/joints"))
    tab.loop.show(
        Row("Joints", "Text", display, "Joints", {}), traffic={"/joints": Traffic(50.0, 1.0)}
    )
    yield tab
    pictures.remove("Joints")


def test_a_text_is_a_pane_with_fields_that_fold(texts: Any, pictures: Pictures) -> None:
    pictures.show("Joints", Pane(Readout("/joints", "sensor_msgs/msg/JointState", JOINTS)))
    pane = texts.page.get_by_label("Text Joints", exact=True)
    texts.wait_for(lambda: pane.count() and "1e+308" in pane.inner_text())
    shown = pane.inner_text()
    assert "/joints · sensor_msgs/msg/JointState" in shown
    assert "5.000 s" in shown
    assert HOSTILE in shown
    assert "left" in shown
    rows = pane.get_by_role("treeitem")
    before = rows.count()
    rows.filter(has_text="header").click()
    assert rows.count() == before - 2
    texts.wait_for(lambda: "50 Hz" in pane.inner_text())
    pictures.show("Joints", Pane(Readout("/joints", "std_msgs/msg/String", String("hello"))))
    texts.wait_for(lambda: "'hello'" in pane.inner_text())


def test_a_text_that_is_folded_is_not_sent(texts: Any, pictures: Pictures) -> None:
    pictures.show("Joints", Pane(Readout("/joints", "std_msgs/msg/String", String("first"))))
    pane = texts.page.get_by_label("Text Joints", exact=True)
    texts.wait_for(lambda: pane.count() and "'first'" in pane.inner_text())
    pane.get_by_role("button", name="Collapse Joints").click()
    texts.wait_for(lambda: not any(pictures._looks.values()))
    pictures.show("Joints", Pane(Readout("/joints", "std_msgs/msg/String", String("second"))))
    pane.get_by_role("button", name="Expand Joints").click()
    texts.wait_for(lambda: "'second'" in pane.inner_text())
