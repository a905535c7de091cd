"""The statuses, findings and picture of a recording at a moment, for tests of bug reports."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from webviz.api.status import Level, Status
from webviz.files.opening import load as load_config
from webviz.shell.report.making import play_through
from webviz.shell.testing.comparing import TOLERANCE, load, share_of_difference
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

__tracebackhide__ = True  # failures are shown where the test calls


@dataclass(frozen=True)
class Replayed:
    """A recording that was played from its start to its end, and is shown at a moment.

    Args:
        statuses: of each display by its name, at the moment.
        findings: the cause of the first warning or error of each id that the doctor found.
    """

    statuses: Mapping[str, Mapping[str, Status]]
    findings: Mapping[str, str]

    def problem(self, display: str, status: str) -> str:
        """Return the text of a status if it is a warning or an error, "" if it is not.

        A display without messages has no other statuses, so its topic counts as well.

        Raises:
            KeyError: there is no such display.
        """
        statuses = self.statuses[display]
        keys = [status, *(key for key in statuses if key.startswith("Topic"))]
        return next(
            (statuses[k].text for k in keys if k in statuses and statuses[k].level >= Level.WARN),
            "",
        )


def replay(bag: Path, config: Path, at_s: float) -> Replayed:
    """Play a recording without a browser, as fast as possible.

    Args:
        bag: a file or folder.
        config: a YAML or .rviz file.
        at_s: the moment, in seconds from the start; of a shorter bag its end.

    Raises:
        webviz.Error: a file cannot be read.
    """
    with contextlib.closing(Player(BagHistory(bag))) as source:
        rows, bag_statuses = play_through(load_config(config), source, at_s)
    return Replayed(
        {row.name: row.statuses for row in rows if row.type != "Group"},
        {each.name: each.text for each in bag_statuses},
    )


def looks_like(bag: Path, config: Path, at_s: float, picture: Path) -> bool:
    """Return whether a recording at a moment looks like a picture; takes a browser.

    Args:
        bag, config, at_s: see `replay`.
        picture: a PNG file, whose size is used.
    """
    from webviz.shell.pictures.capture import capture

    expected = load(picture)
    height, width = expected.shape[:2]
    with contextlib.closing(Player(BagHistory(bag))) as source:
        end_s = (source.history.end_ns - source.history.start_ns) / 1e9
    pixels = capture(config, bag=bag, at=min(at_s, end_s), size=(width, height)).pixels
    return share_of_difference(pixels, expected) <= TOLERANCE
