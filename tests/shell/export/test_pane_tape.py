"""Pictures of panes on the tape of an exported run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from webviz.api.nodes import Pane
from webviz.api.pictures import Mark, Pixels
from webviz.data.images import RawImage, Tone
from webviz.shell.export.recorder import MAX_MARKED, PaneRecorder


def pane(value: int) -> Pane:
    data = np.full(40 * 30, value, np.uint8)
    return Pane(Pixels(RawImage(40, 30, "mono8", 40, False, data), Tone()), 10**9)


def mark(x: float) -> Mark:
    return Mark("points", (x, 1.0), "#ff0000")


def test_marks_that_change_do_not_repeat_their_picture_too_often() -> None:
    tape, still = PaneRecorder(), pane(7)
    parts = [tape.take({"a": replace(still, marks=(mark(x),))})["a"] for x in range(MAX_MARKED + 2)]
    assert all(parts)
    whole = [i for i, each in enumerate(parts) if each and each[1]]
    assert whole == [0, MAX_MARKED + 1]
    sizes = [len(each[0]) for each in parts if each]
    assert max(sizes[1:-1]) < min(sizes[0], sizes[-1])
    assert tape.take({"a": still})["a"]
    again = tape.take({"a": pane(9)})["a"]
    assert again is not None
    assert again[1]


def test_a_pane_that_does_not_change_is_not_recorded_again() -> None:
    tape, still = PaneRecorder(), pane(7)
    tape.take({"a": still})
    assert tape.take({"a": still}) == {}
    assert tape.take({}) == {"a": None}
    back = tape.take({"a": still})["a"]
    assert back is not None
    assert back[1], "A file that shows nothing has no picture to go on from."
