"""Seeks from panels: to the time of what was clicked."""

from __future__ import annotations

from webviz import commands
from webviz.api.errors import Error
from webviz.engine.commands import Command
from webviz.engine.state import PanelTimes
from webviz.sources.past_state import PlaybackState

NS_PER_S = 1e9


def seek_to(playback: PlaybackState | None, clock: PanelTimes, received_ns: int) -> Command:
    """Return the command that shows a time.

    Args:
        playback, clock: of the viewer.
        received_ns: ROS time at which a message was received.

    Raises:
        Error: there is no recording or memory, or the time is not in it.
    """
    if playback is None:
        raise Error("There is no recording to seek in. Open a bag, or turn on the memory.")
    if playback.is_live is not None and clock.is_simulated:
        raise Error("Simulated time cannot be found in the memory. Drag the timeline instead.")
    at_s = (received_ns - playback.start_ns) / NS_PER_S
    end_s = (playback.end_ns - playback.start_ns) / NS_PER_S
    if not playback.first_s <= at_s <= end_s:
        raise Error("This time is no longer in the recording. Choose a later one.")
    return commands.Seek(at_s)
