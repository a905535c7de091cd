"""The process that reads attacked files as the viewer does: names in, answers in JSON out."""

from __future__ import annotations

import contextlib
import io
import json
import logging
import resource
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

from tests.attack.bridges import read_bridge
from tests.attack.media import read_media
from tests.attack.tile_addresses import read_address
from tests.attack.tiles import read_tiles
from tests.attack.zenoh_networks import read_network
from webviz.api.declared import Topic
from webviz.api.errors import Error
from webviz.commands import Seek
from webviz.data.images import ImageError
from webviz.data.map_file import MapFileError, read_map
from webviz.data.messages import MessageError
from webviz.data.names import readable
from webviz.data.tiles import TileError
from webviz.data.transforms.picture import draw_tree
from webviz.engine.loop import FrameLoop
from webviz.files import opening
from webviz.files.config import WatchRule
from webviz.files.report import read_report
from webviz.panels.parameter_values import of_node
from webviz.panels.yaml_text import read_yaml
from webviz.shell.app.reading import read_config
from webviz.shell.cli.frames import read_bag
from webviz.shell.cli.terminal import say, warn
from webviz.shell.doctor.examination import examine_bag
from webviz.shell.doctor.report import to_text
from webviz.shell.doctor.rule_results import RuleResults
from webviz.shell.doctor.scene import NoScene
from webviz.sources import Subscription
from webviz.sources.bag.history import BagHistory
from webviz.sources.bag.qos import profiles_of
from webviz.sources.player import Player
from webviz_urdf import Resolver, load_robot
from webviz_urdf.robot import RobotDescriptionError
from webviz_urdf.textures import TextureError, open_image

REFUSALS = (Error, MessageError, RobotDescriptionError, TextureError, ImageError, TileError)
"""Errors that the viewer shows as a sentence."""
MESH = (
    "<robot name='r'><link name='a'><visual><geometry><mesh filename='{}'/></geometry></visual>"
    "</link></robot>"
)
MAX_MEMORY = 3 << 30
"""Bytes of address space, half a gigabyte of which is taken by imports."""
MAX_STEPS = 1000
"""Largest number of steps of a bag that claims to be long."""
MAX_SENTENCE = 2000
"""Characters of an error."""
SMALL = (".yaml", ".rviz", ".qos", ".metadata", ".map", ".params", ".examined", ".reported", ".zip")
MAX_SMALL_S = 20.0
"""Time of the processor for one text or a bag of some messages, which take a second."""


def read(path: Path) -> None:
    """Read a file; raises what the viewer shows as a sentence."""
    match path.suffix:
        case ".yaml" | ".rviz":
            opening.text_of(opening.load(path), path.name)
        case ".mcap" | ".db3" | ".zst":
            try:
                _play(path)
            except MemoryError as error:
                raise AssertionError("a bag took all memory") from error
        case ".zip":
            _read_report(path)
        case ".image" | ".depth" | ".raw" | ".video":
            read_media(path)
        case ".mbtiles" | ".pmtiles" | ".http":
            read_tiles(path)
        case ".address":
            read_address(path)
        case ".foxglove" | ".rosbridge":
            read_bridge(path)
        case ".zenoh":
            read_network(path)
        case ".png":
            open_image(path).load()
        case ".urdf":
            load_robot(path.read_bytes().decode(errors="replace"), Resolver(roots=[]))
        case ".qos":
            profiles_of(path.read_bytes().decode(errors="replace"))
        case ".metadata":
            folder = path.with_suffix("")
            folder.mkdir(exist_ok=True)
            path.replace(folder / "metadata.yaml")
            Player(BagHistory(folder)).close()
        case ".map":
            try:
                read_map(path)
            except MapFileError as error:
                raise Error(str(error)) from error
        case ".params":
            of_node(read_yaml(path.read_bytes().decode(errors="replace")), "/a")
        case ".examined":
            _examine(path.rename(path.with_suffix(".mcap")))
        case ".reported":
            _report(path.rename(path.with_suffix(".mcap")))
        case _:
            robot = load_robot(MESH.format(path), Resolver(roots=[path.parent]))
            if robot.missing:
                raise RobotDescriptionError(f"{path.name} is missing")


def _read_report(path: Path) -> None:
    """Unpack a bug report, and play what it contains."""
    with tempfile.TemporaryDirectory() as folder:
        report = read_report(path, Path(folder))
        f"{report.report.at_s:.1f} {report.report.made:.1f}"  # as it is announced
        opening.text_of(opening.load(report.config), report.config.name)
        if report.picture is not None:
            open_image(report.picture).load()
        _play(report.bag)


def _play(path: Path) -> None:
    """Play a bag with all of its topics."""
    source = Player(BagHistory(path))
    try:
        subscription = {
            topic: Subscription(offer.publishers[0].type, Topic(topic))
            for topic, offer in source.offers().items()
            if offer.publishers
        }
        source.want(subscription)
        for _ in range(MAX_STEPS):
            source.play_step(source.history.end_ns)
            source.inbox.drain()
            if source.reached_ns >= source.history.end_ns:
                break
    finally:
        source.close()


def _examine(path: Path) -> None:
    """Read a bag as `webviz frames`, `doctor`, `export` and `screenshot` do."""
    for examine in (_frames, _doctor, _show):
        with contextlib.closing(Player(BagHistory(path))) as source:
            examine(source)
            if source.reached_ns < source.history.end_ns:
                raise AssertionError(f"{examine.__name__} ends before the end")


def _report(path: Path) -> None:
    """Check what `webviz frames` and `webviz doctor` write of a bag."""
    lines: list[str] = []
    with contextlib.closing(Player(BagHistory(path))) as source:
        tree = read_bag(source, source.history.end_ns, lambda what, share: None)
        lines += tree.text().split("\n")
        picture = draw_tree(tree.diagnosis, "frames", tree.notes()).svg
        lines += [each for each in ElementTree.fromstring(picture).itertext() if each.strip()]
        sentences = [*source.warnings, *tree.diagnosis.problems]
    with contextlib.closing(Player(BagHistory(path))) as source:
        config = read_config(None, source)
        report = examine_bag(source, config, "bag", lambda what, share: None)
    lines += to_text(report, is_colored=False).split("\n")
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(out):
        say(*sentences)
        warn(*(finding.cause for finding in report.findings))
    count = out.getvalue().count("\n")
    if count != max(1, len(sentences)) + max(1, len(report.findings)):
        raise AssertionError(f"{count} lines of {len(sentences)} and {len(report.findings)} texts")
    lines += out.getvalue().split("\n")
    for line in lines:
        if any(readable(part) != part for part in line.split("\n")):
            raise AssertionError(f"a line commands the terminal: {line!a}")
        if line.startswith("forged"):
            raise AssertionError(f"a line is forged: {line!a}")


def _frames(source: Player) -> None:
    read_bag(source, source.history.end_ns, lambda what, share: None)


def _doctor(source: Player) -> None:
    results = RuleResults("bag", [WatchRule(rule="/marker.rate > 0.1")])
    examine_bag(source, read_config(None, source), "bag", lambda what, share: None, results)


def _show(source: Player) -> None:
    loop = FrameLoop(read_config(None, source), source, NoScene())
    try:
        loop.turn()
        length_s = (source.history.end_ns - source.history.start_ns) / 1e9
        for at_s in (0.0, length_s / 2, length_s):
            answer = loop.enqueue(Seek(at_s))
            for _ in range(MAX_STEPS):
                loop.turn()
                if answer.done():
                    break
            answer.result(0)
    finally:
        loop.close()


def _unreadable(sentence: str) -> str:
    """Return why an error is not a sentence; "" if it is one."""
    if "\n" in sentence:
        return f"several lines: {sentence[:MAX_SENTENCE]}"
    return f"{len(sentence)} characters: {sentence[:200]}" if len(sentence) > MAX_SENTENCE else ""


def serve(read: Callable[[Path], object]) -> None:
    """Read files until there are no more names.

    Args:
        read: reads one; raises what the viewer shows as a sentence.
    """
    logging.disable()
    resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY, MAX_MEMORY))
    for line in sys.stdin:
        broken, is_refused = "", False
        path, start_s = Path(line.rstrip("\n")), time.process_time()
        try:
            read(path)
        except REFUSALS as error:
            is_refused = True
            broken = _unreadable(str(error))
        except MemoryError:
            is_refused = True
            broken = f"{path.name} took all memory" if path.suffix in SMALL else ""
        except Exception:
            broken = traceback.format_exc()
        taken_s = time.process_time() - start_s
        if path.suffix in SMALL and taken_s > MAX_SMALL_S and not broken:
            broken = f"{path.name} took {taken_s:.0f} s"
        print(json.dumps({"refused": is_refused, "broken": broken}), flush=True)


if __name__ == "__main__":
    serve(read)
