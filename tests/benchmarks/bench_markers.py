"""Cost of markers in the frame loop, next to a viewer that makes one viser node of each.

    .venv/bin/python tests/benchmarks/bench_markers.py

Both get the same serialised messages, in turns, without a browser. The plain viewer is as viser's
documentation has it: a node for each marker, whose properties are assigned.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import viser

from webviz import Frames
from webviz.data.messages import decode, encode
from webviz.data.transforms import TransformBuffer
from webviz.engine.pipeline import Runner, Services
from webviz.engine.pipeline.background import Workers
from webviz.scene import ViserScene, open_server
from webviz.sources import Offer, Publisher, Raw
from webviz_displays.markers import MarkerArray

ARRAY, TOPIC = "visualization_msgs/msg/MarkerArray", "/visualization_marker_array"
CUBE, LINES, TEXT, DELETE = 1, 5, 9, 2
ROUNDS = 10


def marker(id: int, type_: int, step: int, **more: Any) -> dict[str, Any]:
    return {
        "header": {"frame_id": "map", "stamp": {"sec": step}},
        "ns": "bench",
        "id": id,
        "type": type_,
        "pose": {
            "position": {"x": id % 100 + 0.01 * step, "y": float(id // 100)},
            "orientation": {"w": 1.0},
        },
        "scale": {"x": 0.5, "y": 0.5, "z": 0.5},
        "color": {"r": 1.0, "g": 0.5, "a": 1.0},
        **more,
    }


def cubes(count: int) -> Callable[[int], list[dict[str, Any]]]:
    return lambda step: [marker(i, CUBE, step) for i in range(count)]


def one_of_many(count: int) -> Callable[[int], list[dict[str, Any]]]:
    whole = cubes(count)
    return lambda step: whole(0) if step == 0 else [marker(count // 2, CUBE, step)]


def lines(step: int) -> list[dict[str, Any]]:
    points = np.random.default_rng(step).normal(size=(100_000, 3))
    return [marker(0, LINES, step, points=points)]


def texts(step: int) -> list[dict[str, Any]]:
    return [marker(i, TEXT, step, text=f"{i}: {step}") for i in range(500)]


def churn(step: int) -> list[dict[str, Any]]:
    new = [marker(10 * step + i, CUBE, step) for i in range(10)]
    return [*new, *(marker(10 * step - 100 + i, CUBE, step, action=DELETE) for i in range(10))]


SCENES: dict[str, Callable[[int], list[dict[str, Any]]]] = {
    "10 000 cubes, all move": cubes(10_000),
    "1 000 cubes, all move": cubes(1000),
    "one of 10 000 cubes moves": one_of_many(10_000),
    "LINE_LIST of 100 000 points": lines,
    "500 texts, all change": texts,
    "20 added and deleted": churn,
}


def webviz_turns(server: Any) -> Iterator[Callable[[bytes], None]]:
    """A function that takes a message and draws it."""
    scene, workers = ViserScene(server), Workers(lambda: None)
    display = MarkerArray()
    runner = Runner("d", display, Services(scene, workers, lambda topic: topic, strict=True))
    offer = Offer((Publisher("/n", ARRAY, "reliable", "volatile"),), ("reliable", "volatile"))
    buffer = TransformBuffer()
    now_ns = 0

    def turn(cdr: bytes) -> None:
        nonlocal now_ns
        now_ns += 50_000_000
        frames = Frames(buffer, "map", now_ns)
        runner.take({TOPIC: [Raw(cdr, now_ns)]}, frames, {TOPIC: offer})
        runner.draw(frames)
        scene.flush()

    yield turn
    runner.close()
    scene.flush()
    workers.close()


def plain_turns(server: viser.ViserServer) -> Iterator[Callable[[bytes], None]]:
    """The same with a node for each marker."""
    nodes: dict[int, Any] = {}

    def turn(cdr: bytes) -> None:
        for m in decode(ARRAY, cdr).markers:
            if m.action == DELETE:
                if m.id in nodes:
                    nodes.pop(m.id).remove()
                continue
            p, name = m.pose.position, f"/plain/{m.id}"
            if m.type == LINES:
                segments = m.points.reshape(-1, 2, 3).astype(np.float32)
                nodes[m.id] = server.scene.add_line_segments(name, segments, (255, 128, 0))
            elif m.type == TEXT:
                nodes[m.id] = server.scene.add_label(name, m.text, position=(p.x, p.y, p.z))
            elif m.id in nodes:
                nodes[m.id].position = (p.x, p.y, p.z)
            else:
                s = m.scale
                nodes[m.id] = server.scene.add_box(
                    name, color=(255, 128, 0), dimensions=(s.x, s.y, s.z), position=(p.x, p.y, p.z)
                )

    yield turn
    for node in nodes.values():
        node.remove()


def main() -> None:
    """Print milliseconds of CPU per message."""
    server = open_server("127.0.0.1", 0)
    print(f"{'scene':32}{'webviz':>10}{'plain':>10}{'ratio':>8}   ms of CPU per message, median")
    for name, make in SCENES.items():
        messages = [encode(ARRAY, {"markers": make(step)}) for step in range(ROUNDS + 1)]
        (ours, theirs), spent = (webviz_turns(server), plain_turns(server)), ([], [])
        turns = next(ours), next(theirs)
        for number, cdr in enumerate(messages):
            for turn, times in zip(turns, spent, strict=True):
                start = time.thread_time()
                turn(cdr)
                if number:  # the first one fills the scene
                    times.append(1e3 * (time.thread_time() - start))
        for each in (ours, theirs):
            next(each, None)
        a, b = (float(np.median(times)) for times in spent)
        print(f"{name:32}{a:10.2f}{b:10.2f}{b / a:8.1f}")
    server.stop()


if __name__ == "__main__":
    main()
