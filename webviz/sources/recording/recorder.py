"""Recording of what arrives, to files, in a thread of its own."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Iterable
from pathlib import Path

from webviz.data.recordings import RecordingError
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.sources.inbox import Raw
from webviz.sources.recording.channels import Channels
from webviz.sources.recording.recent import OVERHEAD, Entry

MAX_BYTES = 256 << 20
"""Limit in bytes of messages that wait for the disk."""
FLUSH_S = 1.0
"""Time between two writes: what is lost at most if the program is killed."""
UNKNOWN_S = 5.0
"""Time that the type of a topic may be unknown before its messages are given up."""


class Recorder:
    """Writes messages to a folder until it is closed.

    Args:
        folder: written to by the thread of the recorder alone.
        channels: of the topics.
        past: what the recording begins with.
        max_bytes: of the files, at which it ends; 0 for no limit.
    """

    def __init__(
        self,
        folder: RecordingFolder,
        channels: Channels,
        past: Iterable[Entry] = (),
        max_bytes: int = 0,
    ) -> None:
        self._folder = folder
        self._channels = channels
        self._lock = threading.Condition()
        self._waiting: deque[Entry] = deque(past)
        self._bytes = sum(len(raw.cdr) for _, raw in self._waiting)
        self._max_bytes = max_bytes
        self._unwritten = (0, 0)
        """Bytes of the files, and of the messages since, which may not be compressed yet."""
        self._clock = ForwardClock()
        self.is_full = False
        """True if it has ended since more would not have fitted."""
        self._is_ending = False
        self._began_s = time.monotonic()
        self.dropped = 0
        """Messages that the disk was too slow for, or whose type was unknown."""
        self.problem = ""
        """Cause of an unrequested end, in a sentence; "" while there is none."""
        self._thread = threading.Thread(target=self._run, name="webviz-recorder", daemon=True)
        self._thread.start()

    @property
    def path(self) -> Path:
        """The folder."""
        return self._folder.path

    @property
    def messages(self) -> int:
        """Messages written so far."""
        return self._folder.messages

    @property
    def bytes_written(self) -> int:
        """Bytes of the files."""
        return self._folder.size

    @property
    def seconds(self) -> float:
        """Time since the recording began."""
        return time.monotonic() - self._began_s

    def put(self, topic: str, raw: Raw) -> None:
        """Add a message, from any thread; the oldest are dropped while the disk is too slow."""
        with self._lock:
            if self._is_ending or self.problem or self.is_full:
                return
            self._waiting.append((topic, raw))
            self._bytes += len(raw.cdr)
            while self._bytes > MAX_BYTES and len(self._waiting) > 1:
                self._bytes -= len(self._waiting.popleft()[1].cdr)
                self.dropped += 1
            self._lock.notify()

    def close(self) -> None:
        """Write what waits and complete the files; waits for the disk."""
        with self._lock:
            self._is_ending = True
            self._lock.notify()
        self._thread.join()

    def _run(self) -> None:
        try:
            while self._write_waiting():
                pass
            self._folder.close()
        except RecordingError as error:
            self.problem = str(error)
            self._forget_waiting()

    def _forget_waiting(self) -> None:
        with self._lock:
            self._waiting.clear()
            self._bytes = 0

    def _write_waiting(self) -> bool:
        """Write for a second, then flush.

        Returns:
            Whether there is more to come.
        """
        until_s = time.monotonic() + FLUSH_S
        while (left_s := until_s - time.monotonic()) > 0:
            with self._lock:
                if not self._waiting:
                    if self._is_ending:
                        return False
                    self._lock.wait(left_s)
                    continue
                topic, raw = self._waiting.popleft()
                self._bytes -= len(raw.cdr)
            self.is_full = self._exceeds(len(raw.cdr))
            if self.is_full:
                self._forget_waiting()
                return False
            self._write(topic, raw)
        self._folder.flush()
        return True

    def _exceeds(self, size: int) -> bool:
        """Return whether a message of this size might make the files too large."""
        written, unwritten = self._folder.size, size + OVERHEAD
        if written == self._unwritten[0]:
            unwritten += self._unwritten[1]
        self._unwritten = written, unwritten
        return 0 < self._max_bytes < written + unwritten

    def _write(self, topic: str, raw: Raw) -> None:
        channel = self._channels.find(topic, raw.types)
        while channel is None and time.monotonic() - raw.arrived_s < UNKNOWN_S:
            time.sleep(0.05)  # the source says soon what it subscribes to
            channel = self._channels.find(topic, raw.types)
        if channel is None:
            self.dropped += 1
            return
        self._folder.add(channel, self._clock.at(raw), raw.cdr, self._channels.latched(topic))


class ForwardClock:
    """Times of recording, which never go back: readers sort by them.

    If ROS time goes back, as with a simulator that starts over or a clock that is corrected, they
    go on by the time that passed since.
    """

    def __init__(self) -> None:
        self._shift_ns = 0
        self._last_ns: int | None = None
        self._arrived_s = 0.0

    def at(self, raw: Raw) -> int:
        """Return the time of recording of the next message."""
        stamp_ns = raw.received_ns + self._shift_ns
        if self._last_ns is not None and stamp_ns < self._last_ns:
            passed_ns = max(0, round((raw.arrived_s - self._arrived_s) * 1e9))
            self._shift_ns += self._last_ns + passed_ns - stamp_ns
            stamp_ns = self._last_ns + passed_ns
        self._last_ns, self._arrived_s = stamp_ns, raw.arrived_s
        return stamp_ns
