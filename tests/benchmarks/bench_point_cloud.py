"""Cost of a PointCloud2 from its bytes to the nodes viser sends, next to the obvious way.

    python tests/benchmarks/bench_point_cloud.py

The obvious way is what a viewer does that is written after the documentation of viser: rosbags
decodes the message, a structured array gives the columns, a colour table the colours, two setters
bring them to viser. The floor is a copy of the bytes. No browser is connected. Times are CPU time
of the process; they depend on the machine and the hour, the ratios are what to compare. Memory is
the peak of what is allocated for one cloud besides the message.
"""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray
from rosbags.typesys import Stores, get_typestore

from webviz import Frames
from webviz.data.transforms import TransformBuffer
from webviz.engine.pipeline import Runner, Services
from webviz.engine.pipeline.background import Workers
from webviz.scene import ViserScene, open_server
from webviz.sources import Offer, Publisher, Raw
from webviz_displays.point_cloud2 import PointCloud2

STORE = get_typestore(Stores.ROS2_JAZZY)
CLOUD = "sensor_msgs/msg/PointCloud2"
TURNED = (0.0, 0.0, 0.6, 0.8)
"""x, y, z, w."""
ROUNDS = 9
SECOND = 1_000_000_000
DTYPES = {2: "u1", 4: "u2", 6: "u4", 7: "f4", 8: "f8"}


def serialized(count: int, channel: str, frame: str, seed: int) -> bytes:
    """A cloud of x, y, z and one channel more."""
    rng = np.random.default_rng(seed)
    points = rng.normal(0, 20, (count, 4)).astype(np.float32)
    if channel == "rgb":
        points[:, 3].view(np.uint32)[:] = rng.integers(0, 1 << 24, count)
    make = STORE.types
    fields: list[Any] = [
        make["sensor_msgs/msg/PointField"](name, 4 * i, 7, 1)
        for i, name in enumerate(("x", "y", "z", channel))
    ]
    header = make["std_msgs/msg/Header"](make["builtin_interfaces/msg/Time"](100, 0), frame)
    data = points.view(np.uint8).reshape(-1)
    cloud = make[CLOUD](header, 1, count, fields, False, 16, 16 * count, data, True)
    return bytes(STORE.serialize_cdr(cloud, CLOUD))


def ours(server: viser.ViserServer, clouds: list[bytes], **properties: Any) -> Callable[[], None]:
    """A turn of the frame loop for each cloud: intake, decoding, drawing, baking, sending."""
    PointCloud2.is_threaded = False  # all of it is to be measured
    scene = ViserScene(server)
    services = Services(scene, Workers(lambda: None), lambda topic: topic, strict=True)
    runner = Runner("cloud", PointCloud2(**properties), services)
    buffer = TransformBuffer()
    buffer.set_transform("map", "lidar", 0, (1.0, 2.0, 3.0), TURNED, True)
    offers = {"/points": Offer((Publisher("", CLOUD, "reliable", "volatile"),), None)}
    waiting = forever(clouds)

    def turn() -> None:
        frames = Frames(buffer, "map", 100 * SECOND)
        runner.take({"/points": [Raw(next(waiting), 100 * SECOND)]}, frames, offers)
        runner.draw(frames)
        scene.flush()

    return turn


def obvious(server: viser.ViserServer, clouds: list[bytes]) -> Callable[[], None]:
    """The same picture without webviz."""
    handle = server.scene.add_point_cloud(
        "/obvious", np.zeros((1, 3), np.float32), np.zeros((1, 3), np.uint8), precision="float32"
    )
    x, y, z, w = TURNED
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    hues = np.linspace(0, 5, 256)[:, None] + (2.0, 0.0, 4.0)
    table = (np.clip(np.abs((hues % 6) - 3) - 1, 0, 1) * 255).astype(np.uint8)
    waiting = forever(clouds)

    def turn() -> None:
        message: Any = STORE.deserialize_cdr(next(waiting), CLOUD)
        layout = np.dtype(
            {
                "names": [field.name for field in message.fields],
                "formats": [DTYPES[field.datatype] for field in message.fields],
                "offsets": [field.offset for field in message.fields],
                "itemsize": message.point_step,
            }
        )
        points = message.data.view(layout)
        xyz = np.stack([points["x"], points["y"], points["z"]], axis=-1)
        finite = np.isfinite(xyz).all(axis=1)
        xyz, points = xyz[finite], points[finite]
        colors: NDArray[np.uint8]
        if message.fields[3].name == "rgb":
            packed = points["rgb"].view(np.uint32)
            parts = [(packed >> shift) & 255 for shift in (16, 8, 0)]
            colors = np.stack(parts, axis=-1).astype(np.uint8)
        else:
            values = points["intensity"]
            where = (values - values.min()) / (values.max() - values.min())
            colors = table[(where * 255).astype(int)]
        if message.header.frame_id == "lidar":
            xyz = xyz @ rotation.T + (1.0, 2.0, 3.0)
        handle.points = xyz.astype(np.float32)
        handle.colors = colors
        server.flush()

    return turn


def forever(clouds: list[bytes]) -> Iterator[bytes]:
    """The clouds in turns, so that no cloud is the one before."""
    while True:
        yield from clouds


def milliseconds(candidates: list[Callable[[], object]]) -> list[float]:
    """Least CPU time of each, measured in turns so that a slow moment hits all."""
    for candidate in candidates:
        candidate()
    best = [float("inf")] * len(candidates)
    for _ in range(ROUNDS):
        for index, candidate in enumerate(candidates):
            time.sleep(0.05)  # the threads of numpy's linear algebra go on spinning for a while
            began = time.process_time()
            candidate()
            best[index] = min(best[index], (time.process_time() - began) * 1e3)
    return best


def bytes_at_peak(candidate: Callable[[], object]) -> int:
    """The most memory that one call allocates at a time."""
    candidate()
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    candidate()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak - before


def main() -> None:
    """Print the table."""
    columns = ("floor ms", "obvious ms", "webviz ms", "webviz/obvious")
    print(f"{'':42}" + "".join(f"{c:>15}" for c in columns) + f"{'bytes a point':>24}")
    server = open_server(port=0)
    for count in (100_000, 1_000_000):
        for frame, channel in (
            ("map", "rgb"),
            ("map", "intensity"),
            ("lidar", "rgb"),
            ("lidar", "intensity"),
        ):
            clouds = [serialized(count, channel, frame, seed) for seed in (1, 2)]
            plain = obvious(server, clouds)
            rows = {"": ours(server, clouds, max_points=0)}
            if count > 300_000:
                rows[", 300k shown"] = ours(server, clouds, max_points=300_000)
            for which, candidate in rows.items():
                floor, b, a = milliseconds([partial(bytearray, clouds[0]), plain, candidate])
                peaks = [bytes_at_peak(each) / count for each in (plain, candidate)]
                where = "fixed frame" if frame == "map" else "turned frame"
                label = f"{count // 1000}k {channel}, {where}{which}"
                print(
                    f"{label:42}{floor:15.2f}{b:15.2f}{a:15.2f}{a / b:15.2f}"
                    f"{f'{peaks[1]:.0f}, obvious {peaks[0]:.0f}':>24}"
                )
    server.stop()


if __name__ == "__main__":
    main()
