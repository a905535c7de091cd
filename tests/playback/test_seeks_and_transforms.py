"""Seeks where transforms come late, end, and start over: nodes and statuses of a straight play."""

from __future__ import annotations

from pathlib import Path

import pytest
from bags import START_NS, TF, Bag, ns, stamped

from webviz.shell.testing import check_seeks


def stamped_behind(lag_s: float) -> Bag:
    """Transforms of 12 s whose stamps are behind the time of recording; those of one frame end."""
    bag = Bag()
    bag.add("/tf", TF)
    for step in range(24):
        at_s = step / 2
        stamp_ns = START_NS + ns(at_s - lag_s)
        moving = [stamped("map", "base", stamp_ns, at_s)]
        if at_s < 3.0:
            moving.append(stamped("base", "arm", stamp_ns, 1.0))
        bag.put(at_s, "/tf", {"transforms": moving})
    return bag


@pytest.mark.parametrize("lag_s", [0.0, 60.0, -3600.0])
def test_frames_age_from_when_they_were_received(tmp_path: Path, lag_s: float) -> None:
    config = "fixed_frame: map\ndisplays: [{type: TF, frame_timeout: 9}]\n"
    path = stamped_behind(lag_s).write_file(tmp_path / "run.mcap")
    check_seeks(path, config, times=[5.05, 1.0, 11.3, 8.2, 2.9])
