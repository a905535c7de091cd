"""Cost of tracing samples, with and without a request, in one run.

    python tests/benchmarks/bench_trace.py

A turn of one display with one small message: intake, decoding, drawing. Three runners take turns,
in processor time: one whose tracer is cut out, one that nobody asks, one that is asked about every
sample. Of the rounds the median is shown; compare the ratios.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from concurrent.futures import Future
from typing import Annotated

from webviz import Context, Display, Frames, Input, Sample, Topic
from webviz.data.messages import encode
from webviz.data.transforms import TransformBuffer
from webviz.engine.pipeline import Runner, Services, Workers
from webviz.engine.state.trace import Tracer
from webviz.shell.testing.messages import header
from webviz.shell.testing.recording import RecordingScene
from webviz.sources import Raw

POSE = "geometry_msgs/msg/PoseStamped"
SECOND = 1_000_000_000
ROUNDS = 41
TURNS = 500


class Dot(Display):
    """A dot where a pose is."""

    topic: Annotated[Topic, Input(POSE)] = Topic("/pose")

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One point."""
        ctx.points("dot", [[0, 0, 0]], (255, 0, 0), 0.1)


class CutOut(Tracer):
    """Knows nothing without a look."""

    def wants(self, display: str) -> bool:
        """No."""
        return False


def turns(tracer: Tracer, *, asks: bool, stamps: bool = True) -> Callable[[], None]:
    """So many turns of a runner.

    Args:
        tracer: of the runner.
        asks: for every sample.
        stamps: messages note when they arrive.
    """
    workers = Workers(lambda: None)
    services = Services(RecordingScene(), workers, lambda topic: topic, tracer=tracer)
    runner = Runner("dot", Dot(name="Dot"), services)
    buffer = TransformBuffer()
    buffer.set_transform("map", "base", 0, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0), True)
    values = {"header": header("base", 100 * SECOND), "pose": {"orientation": {"w": 1.0}}}
    cdr = encode(POSE, values)

    def run() -> None:
        for _ in range(TURNS):
            if asks:
                tracer.ask("dot", Future())
            frames = Frames(buffer, "map", 100 * SECOND)
            raw = Raw(cdr, 100 * SECOND) if stamps else Raw(cdr, 100 * SECOND, 0.0)
            runner.take({"/pose": [raw]}, frames, {})
            runner.draw(frames)
            tracer.sent()

    return run


def main() -> None:
    """Print microseconds per sample, and ratios."""
    cases = {
        "cut out": turns(CutOut(time.monotonic), asks=False, stamps=False),
        "nobody asks": turns(Tracer(time.monotonic), asks=False),
        "asked for every sample": turns(Tracer(time.monotonic), asks=True),
    }
    times: dict[str, list[float]] = {name: [] for name in cases}
    for _ in range(ROUNDS):
        for name, run in cases.items():
            began = time.process_time()
            run()
            times[name].append((time.process_time() - began) / TURNS * 1e6)
    base = statistics.median(times["cut out"])
    for name, each in times.items():
        middle = statistics.median(each)
        print(f"{name:24} {middle:7.1f} us per sample  x {middle / base:.3f}")


if __name__ == "__main__":
    main()
