"""The rare tail: the slowest of many messages, and the steps of webviz that they waited for.

    python -m side_by_side.tail [--scene D] [--minutes 10]

The first minute is reported separately, since pages join and modules are imported then. Run it on
a quiet machine.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

from side_by_side.case import GIVE_UP_S, Case, wait_for
from side_by_side.scenes import SCENES
from side_by_side.systems.registry import TRACED

FIRST_S = 60.0
BEAT_S = 0.001
SLOWEST = 12


class Message(NamedTuple):
    """A message that was shown.

    Args:
        published_ns: since 1970.
        late_ms: from its publication to the client.
    """

    published_ns: int
    late_ms: float


class Step(NamedTuple):
    """A slow step of webviz."""

    ended_ns: int
    took_ms: float
    text: str

    def overlaps(self, message: Message) -> bool:
        """Return whether it ran while a message was on its way."""
        seen_ns = message.published_ns + message.late_ms * 1e6
        began_ns = self.ended_ns - self.took_ms * 1e6
        return began_ns < seen_ns and self.ended_ns > message.published_ns


class Heartbeat:
    """Waits of this process, for which the machine is the cause, and not webviz."""

    def __init__(self) -> None:
        self.steps: list[Step] = []
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def end(self) -> None:
        """Stop listening to it."""
        self._ended.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._ended.is_set():
            began = time.perf_counter()
            time.sleep(BEAT_S)
            took_ms = 1e3 * (time.perf_counter() - began)
            if took_ms >= 5.0:
                self.steps.append(Step(time.time_ns(), took_ms, "the measuring process slept"))


def read(path: Path) -> list[Step]:
    """Return the steps that `systems.traced` wrote."""
    steps: list[Step] = []
    for line in path.read_text().splitlines():
        ended_ns, took_ms, thread, text = line.split("\t", 3)
        steps.append(Step(int(ended_ns), float(took_ms), f"{thread}: {text}"))
    return steps


def summary(title: str, messages: list[Message]) -> str:
    """Say how late messages were."""
    if not messages:
        return f"{title}: none"
    late = np.array([each.late_ms for each in messages])
    parts = [f"p{share:g} {np.percentile(late, share):.1f}" for share in (50, 99, 99.9)]
    return f"{title}: {len(late)} messages, {', '.join(parts)}, most {late.max():.1f} ms"


def main() -> int:
    """Print the percentiles, and what the slowest messages waited for."""
    parser = argparse.ArgumentParser(prog="side_by_side.tail", description=__doc__)
    parser.add_argument("--scene", default="D", choices=list(SCENES))
    parser.add_argument("--minutes", type=float, default=10.0)
    options = parser.parse_args()
    scene = SCENES[options.scene]
    with tempfile.TemporaryDirectory() as folder, Case(TRACED, scene, Path(folder)) as case:
        watcher, heartbeat = case.watch(), Heartbeat()
        wait_for(lambda: watcher.sightings, "no publication was seen", GIVE_UP_S)
        start_ns = time.time_ns()
        time.sleep(60.0 * options.minutes)
        end_ns = time.time_ns()
        time.sleep(1.0)
        heartbeat.end()
        late = case.log().publications(watcher.sightings, start_ns, end_ns)
        messages = [Message(at_ns, ms) for at_ns, ms in late.get(scene.lane, [])]
        published = case.log().published(scene.lane, start_ns, end_ns)
        watcher.close()
        steps = [*read(Path(folder) / "steps.txt"), *heartbeat.steps]
    first_ns = start_ns + FIRST_S * 1e9
    print(f"{published} published")
    print(summary("first minute", [each for each in messages if each.published_ns < first_ns]))
    print(summary("afterwards", [each for each in messages if each.published_ns >= first_ns]))
    for message in sorted(messages, key=lambda each: -each.late_ms)[:SLOWEST]:
        print(f"{message.late_ms:8.1f} ms, {(message.published_ns - start_ns) / 1e9:6.1f} s:")
        results = [each for each in steps if each.overlaps(message)]
        for step in sorted(results, key=lambda each: -each.took_ms)[:6]:
            print(f"{'':12}{step.took_ms:7.1f} ms  {step.text}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
