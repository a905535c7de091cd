"""A span of a bag played by hand, and what a page would be sent of it."""

from __future__ import annotations

import contextlib
import itertools
import math
import time
from collections.abc import Callable, Collection, Iterator, Mapping

import msgspec

from webviz.api.frames import Frames
from webviz.api.nodes import Pane
from webviz.api.pictures import Video
from webviz.api.views import FIXED_FRAME
from webviz.commands import Refresh
from webviz.engine.pipeline.selectable import SelectableValues
from webviz.files.config import Config
from webviz.page.pages import Pages
from webviz.scene import ViserScene, open_server
from webviz.scene.adapter.tape import SceneRecorder
from webviz.scene.cameras import ViserCameras
from webviz.server.http.viser_server import Server
from webviz.server.images.encoding import factor_for, file_of
from webviz.server.images.frames import SentPicture, frame
from webviz.shell.export.stores import VALUES, RecordingChannel
from webviz.shell.export.tape import ExportFrame
from webviz.shell.pictures.offline_viewer import OfflineViewer
from webviz.sources.player import Player
from webviz.sources.steps import steps_of

WIDTH = 720
"""Pixels of a pane on the screen: of larger pictures, every second or third pixel is left out."""


MAX_MARKED = 30
"""Times that only the marks of a picture change, before it is written once more: a file goes
through all of them to show the last."""


class PaneRecorder:
    """Makes pictures of those panes that have changed."""

    def __init__(self) -> None:
        self._current_panes: dict[str, Pane] = {}
        self._pictures: dict[str, SentPicture] = {}
        self._marked: dict[str, int] = {}
        self._number = 0

    def take(self, panes: Mapping[str, Pane]) -> Mapping[str, tuple[bytes, bool] | None]:
        """Return new pictures, and whether each can be shown without those before.

        None if one is gone.
        """
        changes: dict[str, tuple[bytes, bool] | None] = {}
        for removed in self._current_panes.keys() - panes.keys():
            del self._current_panes[removed]
            self._pictures.pop(removed, None)
            changes[removed] = None
        for display, pane in panes.items():
            if self._current_panes.get(display) is pane:
                continue
            self._current_panes[display] = pane
            self._number += 1
            picture, sent_picture, file = (
                pane.picture,
                self._pictures.get(display, SentPicture()),
                None,
            )
            marked = self._marked.get(display, 0) + 1
            if isinstance(picture, Video):
                is_whole = sent_picture.packet < picture.packets[0].number
            elif sent_picture.has(picture) and marked <= MAX_MARKED:
                is_whole = False
            else:
                is_whole, sent_picture = True, SentPicture()
                file = file_of(picture, factor_for(picture, WIDTH))
            self._marked[display] = 0 if is_whole else marked
            data, self._pictures[display] = frame(
                display, self._number, pane, file, sent_picture, False
            )
            if data:
                changes[display] = data, is_whole
        return changes


SLOW_S = 1.0
"""Pause in seconds between two records of the stores that change all the time."""
REFRESHES = 3
"""Number of refreshes until stores are there that parts make only once they are watched."""
PATIENCE_S = 60.0
"""Time in seconds for one frame: the first may have to load the meshes of a robot."""


MAX_FOLLOWED = 64
"""Frames that views can follow."""


class RecordedCameras(ViserCameras):
    """Cameras that may follow any frame."""

    followed: Collection[str] = frozenset[str]()
    """Frames whose poses are recorded."""

    def target_frames(self) -> set[str]:
        """Return the frames that a user may choose, and that of the view to start with."""
        return super().target_frames().union(self.followed)


class RecordedScene(ViserScene):
    """A scene that is drawn although no browser is connected."""

    def __init__(self, server: Server) -> None:
        super().__init__(server)
        self.cameras: RecordedCameras = RecordedCameras(self.link)

    def has_watchers(self) -> bool:
        """Return True: a recording reads everything."""
        return True

    def is_unseen(self, display: str) -> bool:
        """Return False: each pane can be opened in the file."""
        return False


class ExportSpan(msgspec.Struct, frozen=True):
    """Part of a bag to record.

    Args:
        first_ns, last_ns: times of recording.
        rate_hz: frames per second.
    """

    first_ns: int
    last_ns: int
    rate_hz: float


class RunRecorder:
    """A viewer whose scene, panels and panes are recorded.

    Args:
        config: what to show.
        source: the bag.
    """

    def __init__(self, config: Config, source: Player) -> None:
        self._source = source
        self._values = SelectableValues()
        with contextlib.ExitStack() as stack:
            server = open_server(port=0)
            stack.callback(server.stop)
            self._scene = RecordedScene(server)
            self._tape = SceneRecorder(server)
            stack.callback(self._tape.close)
            self.channel = RecordingChannel()
            self._panes = PaneRecorder()
            self._pages: Pages | None = None
            self.viewer = OfflineViewer(config, source, self._scene, self._show)
            stack.callback(self.viewer.close)
            loop = self.viewer.loop
            self._pages = Pages(self.channel, loop.enqueue, parts=loop.parts)
            self._stack = stack.pop_all()

    @property
    def followed(self) -> Collection[str]:
        """The frames whose poses are recorded."""
        return self._scene.cameras.followed

    def close(self) -> None:
        """Stop the viewer."""
        self._stack.close()

    def frames(
        self, span: ExportSpan, tell: Callable[[float], object] = lambda share: None
    ) -> Iterator[ExportFrame]:
        """Play a span.

        Args:
            span: what to record.
            tell: called with the share that is done.
        """
        slow_s = -math.inf
        length_s = (span.last_ns - span.first_ns) / 1e9
        times = steps_of(self._source, span.first_ns, span.last_ns, 1e9 / span.rate_hz)
        for number, at_ns in enumerate(times):
            deadline = time.monotonic() + PATIENCE_S
            at_s = (at_ns - span.first_ns) / 1e9
            self.viewer.seek(self._source, at_ns, deadline)
            self.viewer.wait((), deadline)
            self._follow_frames()
            is_slow_due = at_s - slow_s >= SLOW_S - 1e-6
            slow_s = at_s if is_slow_due else slow_s
            self.viewer.loop.update()
            self.channel.follow(self.viewer.loop.fact)
            for _ in range(REFRESHES if number == 0 else 1):
                self.viewer.do(Refresh())
            self._scene.complete(PATIENCE_S)
            self._show_values()
            pictures = self._panes.take(self._scene.link.pictures.panes())
            ros_s = self._source.now_ns() / 1e9
            stores = self.channel.take(is_slow_due)
            yield ExportFrame(at_s, ros_s, self._tape.take(), stores, pictures)
            tell(at_s / length_s if length_s else 1.0)

    def _show_values(self) -> None:
        """Record the details of what can be selected."""
        frames = self._frames()
        for runner in self.viewer.loop.runners():
            self.channel.show(f"{VALUES}{runner.id}", self._values.of(runner, frames))

    def _frames(self) -> Frames:
        """Return the transforms at the time that is shown."""
        loop = self.viewer.loop
        return Frames(loop.buffer, loop.settings.fixed_frame, self._source.now_ns())

    def _follow_frames(self) -> None:
        """Record the poses of all frames that have one, as far as there are not too many."""
        loop = self.viewer.loop
        frames = self._frames()
        targets = [view.target_frame for view in loop.settings.views.values()]
        candidates = dict.fromkeys([*targets, *sorted(loop.buffer.frames())])
        valid = (frame for frame in candidates if frame != FIXED_FRAME and frames.latest(frame))
        room = MAX_FOLLOWED - len(self.followed)
        new = itertools.islice((frame for frame in valid if frame not in self.followed), room)
        self._scene.cameras.followed = frozenset((*self.followed, *new))

    def _show(self) -> None:
        if self._pages is not None:
            self._pages.update()
