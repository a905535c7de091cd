"""Growth of memory: everything at once for minutes, with a client that has stopped reading.

    python -m side_by_side.memory [--seconds 600] [--scene G]

tests/benchmarks/test_memory.py runs a short one.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from side_by_side.case import SAMPLES_PER_S, Case, CaseFailed
from side_by_side.scenes import SCENES, Scene
from side_by_side.systems.registry import SYSTEMS, System
from side_by_side.watchers import ViserWatcher

WARM_UP_S = 10.0
"""Buffers of every size have been needed once by then."""


@dataclass(frozen=True)
class Soak:
    """Result of a soak.

    Args:
        times: of the samples after the warm-up, s (N,).
        resident: memory at these, MB (N,).
        nodes: of viser at the client that reads at these (N,); 0 for other systems.
        gaps: the longest time without anything new at the client that reads, s, by lane.
    """

    times: NDArray[np.float64]
    resident: NDArray[np.float64]
    nodes: NDArray[np.float64]
    gaps: dict[int, float]

    @property
    def slope(self) -> float:
        """MB per minute."""
        return slope(self.times, self.resident)


def slope(times: NDArray[np.float64], values: NDArray[np.float64]) -> float:
    """Growth per minute: the median of the slopes between all samples far apart (Theil-Sen).

    A single step, as when an allocator takes a larger piece, does not count as growth.

    Args:
        times: of the samples, s (N,).
        values: at these (N,).
    """
    i, j = np.triu_indices(len(times), len(times) // 4)
    return 60 * float(np.median((values[j] - values[i]) / (times[j] - times[i])))


def soak(system: System, scene: Scene, seconds: float, folder: Path) -> Soak:
    """Run a scene with one client that reads and one that does not.

    Raises:
        CaseFailed: the system or the client that reads did not last.
    """
    with Case(system, scene, folder) as case:
        reader = case.watch()
        stalled = case.watch(recognise=False, stalls=True)
        try:
            case.wait_until_steady()
            start, samples = time.monotonic(), []
            while (now := time.monotonic() - start) < seconds:
                if now > WARM_UP_S:
                    nodes = len(reader.nodes) if isinstance(reader, ViserWatcher) else 0
                    samples.append((now, case.rss(), nodes))
                if not reader.is_connected:
                    raise CaseFailed(f"the client lost its viewer: {case.program.output()[-300:]}")
                time.sleep(1 / SAMPLES_PER_S)
            times, resident, nodes = np.array(samples).T
            return Soak(times, resident, nodes, case.log().gaps(reader.sightings, time.time_ns()))
        finally:
            reader.close()
            stalled.close()


def main() -> int:
    """Print the slope, and memory over time."""
    parser = argparse.ArgumentParser(prog="side_by_side.memory", description=__doc__)
    parser.add_argument("--scene", default="G", choices=list(SCENES))
    parser.add_argument("--system", default="webviz", choices=list(SYSTEMS))
    parser.add_argument("--seconds", type=float, default=600.0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        system, scene = SYSTEMS[options.system], SCENES[options.scene]
        result = soak(system, scene, options.seconds, Path(folder))
    for part in np.array_split(np.arange(len(result.times)), 12):
        memory, nodes = result.resident[part], result.nodes[part]
        print(
            f"{result.times[part[-1]]:6.0f} s  {memory.min():.1f} to {memory.max():.1f} MB, "
            f"{nodes.min():.0f} to {nodes.max():.0f} nodes"
        )
    print(f"slope: {result.slope:+.2f} MB a minute")
    print(f"longest time without anything new: {max(result.gaps.values()):.2f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
