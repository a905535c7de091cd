"""Recording of what arrives, to files, in a thread of its own."""

from __future__ import annotations

import threading
import time
from collections import deque
from pathlib import Path

from webviz.data.recordings import RecordingError
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.sources.inbox import Raw
from webviz.sources.recording.channels import Channels
from webviz.sources.recording.recent import Remembered

MAX_BYTES = 256 << 20
"""Of messages that wait for the disk."""
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
    """

    def __init__(self, folder: RecordingFolder, channels: Channels, past: Remembered) -> None:
        self._folder = folder
        self._channels = channels
        self._lock = threading.Condition()
        self._waiting: deque[tuple[str, Raw]] = deque(past.messages)
        self._bytes = sum(len(raw.cdr) for _, raw in past.messages)
        self._latched = past.latched
        self._is_ending = False
        self._began_s = time.monotonic()
        self.dropped = 0
        """Messages that the disk was too slow for, or whose type nobody knew."""
        self.problem = ""
        """Cause of an end by itself, in a sentence; "" while there is none."""
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
            if self._is_ending or self.problem:
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
            self._write_latched()
            while self._write_waiting():
                pass
            self._folder.close()
        except RecordingError as error:
            self.problem = str(error)
            with self._lock:
                self._waiting.clear()
                self._bytes = 0

    def _write_latched(self) -> None:
        """Begin with what late subscribers receive, as if it had just arrived."""
        first = self._waiting[0][1].received_ns if self._waiting else None
        for topic, raw in self._latched.items():
            self._write(topic, raw, first or raw.received_ns)

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
            self._write(topic, raw, raw.received_ns)
        self._folder.flush()
        return True

    def _write(self, topic: str, raw: Raw, stamp_ns: int) -> None:
        channel = self._channels.find(topic)
        while channel is None and time.monotonic() - raw.arrived_s < UNKNOWN_S:
            time.sleep(0.05)  # the source says soon what it subscribes to
            channel = self._channels.find(topic)
        if channel is None:
            self.dropped += 1
            return
        self._folder.add(channel, stamp_ns, raw.cdr, self._channels.is_latched(topic))
