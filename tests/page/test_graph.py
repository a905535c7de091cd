"""The panel Graph in a real browser: what is drawn, folded, searched and saved."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.page.opened_panels import open_panel
from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.api.declared import make
from webviz.commands import InspectTopic
from webviz.panels.graph import MAX_TOPICS, NodeGraph, mismatch, topic_of
from webviz.sources import Endpoint, Offer, Publisher

HOSTILE = "/<img src=x onerror=alert(1)>"
TYPE = "std_msgs/msg/String"


@pytest.fixture(autouse=True)
def _close(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[None]:
    yield
    viewer.show()
    viewer_tab.show_tab("Displays")
    # Else, on a busy machine, the next panel would keep what was unfolded and found in this one.
    viewer_tab.wait_for(lambda: not viewer_tab.page.locator(".wv-graph-canvas").count())


def publisher(node: str, reliability: str = "best_effort") -> Publisher:
    return Publisher(node, TYPE, reliability, "volatile")  # pyright: ignore[reportArgumentType]


def reader(node: str, reliability: str = "best_effort", durability: str = "volatile") -> Endpoint:
    return Endpoint(node, TYPE, reliability, durability)  # pyright: ignore[reportArgumentType]


def offer(*publishers: str, to: tuple[Endpoint, ...] = ()) -> Offer:
    return Offer(tuple(map(publisher, publishers)), readers=to)


def open_graph(viewer: PageBench, tab: ViewerTab, offers: dict[str, Offer]) -> None:
    """Open the panel, with these topics and no others."""
    viewer.source.topics = offers
    open_panel(tab, make(NodeGraph, {}))


def measure(viewer: PageBench, topic: str, hz: float) -> None:
    """Follow a topic with messages at a rate, until it is measured."""
    viewer.do(InspectTopic(topic))
    for _ in range(round(4 * hz)):
        viewer.pass_time(1 / hz)
        viewer.publish(topic, TYPE, {})
        viewer.turn()


def label(tab: ViewerTab) -> str:
    return tab.page.locator(".wv-graph-canvas").get_attribute("aria-label") or ""


def test_a_mismatch_is_told_in_a_sentence() -> None:
    asking = reader("/map", "reliable")
    assert mismatch(asking, [publisher("/a", "reliable")]) == ""
    assert mismatch(asking, [publisher("/a", "reliable"), publisher("/b")]) == (
        "/map asks for reliable, but /b offers best effort."
    )
    late = reader("/map", "best_effort", "transient_local")
    assert "asks for transient local, but /b offers volatile." in mismatch(late, [publisher("/b")])
    assert mismatch(late, []) == ""


def test_an_end_without_a_node_is_a_program_or_behind_the_bridge() -> None:
    behind = Publisher("", TYPE, "reliable", "volatile", is_qos_known=False)
    result = topic_of("/scan", Offer((publisher(""), behind)), lambda name: False)
    assert result["from"] == ["a DDS program", "the bridge"]


def test_the_graph_is_searched_and_a_topic_says_what_does_not_arrive(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    offers = {
        "/scan": offer("/driver", to=(reader("/amcl"), reader("/map", "reliable"))),
        HOSTILE: offer("", to=(reader(HOSTILE),)),
        "/rosout": offer("/driver", to=(reader("/webviz"),)),
        "/dock/_action/status": offer("/dock"),
    }
    open_graph(viewer, tab, offers)
    measure(viewer, "/scan", 10.0)
    tab.wait_for(lambda: label(tab) == "Graph: 7 boxes, 1 QoS mismatch")
    search = tab.page.get_by_label("Find nodes and topics")
    search.fill("SCAN")
    tab.wait_for(lambda: label(tab) == "Graph: 1 of 7")
    search.press("Enter")
    detail = tab.page.locator(".wv-graph-detail")
    tab.wait_for(detail.is_visible)
    assert detail.inner_text().split("\n") == [
        *("/scan", TYPE, "Does not arrive"),
        "/map asks for reliable, but /driver offers best effort.",
        *("Published by", "/driver", "Read by", "/amcl", "/map"),
    ]


def test_the_drawing_is_saved_as_svg_with_texts_as_texts(
    viewer: PageBench, viewer_tab: ViewerTab, tmp_path: Path
) -> None:
    tab = viewer_tab
    offers = {HOSTILE: offer("/driver", to=(reader("/map", "reliable"),))}
    open_graph(viewer, tab, offers)
    measure(viewer, HOSTILE, 2.5)
    tab.wait_for(lambda: label(tab).startswith("Graph: 3 boxes"))
    with tab.page.expect_download() as download:
        tab.button("Download as SVG").click()
    file = tmp_path / "graph.svg"
    download.value.save_as(file)
    root = ElementTree.parse(file).getroot()
    assert {element.tag.rpartition("}")[2] for element in root.iter()} == {
        *("svg", "rect", "path", "text", "title")
    }
    texts = [text.strip() for text in root.itertext()]
    assert HOSTILE in texts
    assert texts.count("2.5 Hz") == 2
    assert "/map asks for reliable, but /driver offers best effort." in texts


def test_a_large_graph_begins_folded_and_is_drawn_quickly(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    offers = {
        f"/robot{i % 20}/part{i % 7}/topic{i}": offer(
            f"/robot{i % 20}/node{i // 20 % 10}",
            to=(reader(f"/robot{(i + 1) % 20}/node{i // 20 % 10}"),),
        )
        for i in range(2000)
    }
    open_graph(viewer, tab, offers)
    tab.wait_for(lambda: label(tab) == "Graph: 20 boxes")
    tab.button("Fold or unfold all namespaces").click()
    tab.wait_for(lambda: label(tab) == "Graph: 2200 boxes")
    tab.button("Fold or unfold all namespaces").click()
    tab.wait_for(lambda: label(tab) == "Graph: 20 boxes")


def test_more_topics_than_the_limit_are_counted(viewer: PageBench, viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    offers = {f"/t{i}": offer("/node") for i in range(MAX_TOPICS + 3)}
    open_graph(viewer, tab, offers)
    tab.wait_for(lambda: f"3 topics not shown; the limit is {MAX_TOPICS}." in tab.text())
