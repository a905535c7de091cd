"""Text from ROS is shown literally, whatever it holds."""

from __future__ import annotations

from html.parser import HTMLParser

import pytest
from hypothesis import given
from hypothesis import strategies as st

from webviz.api.status import Level, Status
from webviz.edges.gui.text import MAX_STATUSES, escape, plain, statuses_html

HOSTILE = [
    "<img src=x onerror=alert(1)>",
    "</div><script>alert(1)</script>",
    "`code` and ```",
    "[a link](javascript:alert(1))",
    "![](http://example.com/x.png)",
    "&lt;b&gt; &amp;",
    "\" onmouseover='alert(1)'",
    "<!-- <![CDATA[",
]


class Reader(HTMLParser):
    """Collects what a browser would take for text and for elements."""

    def __init__(self) -> None:
        super().__init__()
        self.text = ""
        self.tags: list[str] = []

    def handle_data(self, data: str) -> None:
        self.text += data

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.tags.append(tag)

    def handle_comment(self, data: str) -> None:
        self.tags.append("comment")

    def handle_decl(self, decl: str) -> None:
        self.tags.append("declaration")


def read(markup: str) -> Reader:
    reader = Reader()
    reader.feed(markup)
    reader.close()
    return reader


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_text_stays_the_text_that_it_is(text: str) -> None:
    assert read(escape(text)).text == text
    assert read(escape(text)).tags == []


@given(st.text(max_size=200))
def test_no_text_becomes_an_element(text: str) -> None:
    reader = read(escape(text))
    assert reader.tags == []
    assert reader.text == plain(text)


@given(st.text(st.characters(categories=["Cc", "Cs", "Lu", "Zl"]), max_size=50))
def test_plain_text_is_one_line_that_can_be_sent(text: str) -> None:
    assert len(plain(text).encode().splitlines()) <= 1


def test_text_that_reverses_what_follows_is_disarmed() -> None:
    assert plain("scan\u202egnp") == "scan gnp"


def test_endless_text_is_cut() -> None:
    assert plain("x" * 10_000, 10) == "x" * 9 + "…"


def test_each_status_is_a_line_with_key_and_sentence() -> None:
    reader = read(
        statuses_html({"<Topic>": Status(Level.OK, "fine"), "TF": Status(Level.WARN, "a < b")})
    )
    assert reader.text == "<Topic>: fine▲ TF: a < b"


def test_of_too_many_statuses_the_worst_are_shown() -> None:
    statuses = {f"frame {i}": Status(Level.OK, "fine") for i in range(500)}
    statuses["last"] = Status(Level.ERROR, "lost")
    text = read(statuses_html(statuses)).text
    assert "last: lost" in text
    assert f"… and {501 - MAX_STATUSES} more" in text
