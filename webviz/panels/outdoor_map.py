"""The panel Outdoor map: tracks of satellite receivers over map tiles."""

from __future__ import annotations

import base64
import math
import threading
from collections import OrderedDict
from collections.abc import Iterable, Mapping, Sequence
from typing import Annotated, Any

import msgspec

from webviz.api.declared import Prop
from webviz.api.lookback import Lookback
from webviz.api.offer import Offer
from webviz.api.panel import Panel, Send, Ui
from webviz.data.disk import DiskThreads
from webviz.data.geo import MAX_LATITUDE, MAX_ZOOM
from webviz.data.tiles import TileError, TileSource, decoded, open_tiles
from webviz.data.words import counted
from webviz.panels.reading import types_of

Tile = tuple[int, int, int]
"""Level, column from the west and row from the north."""

MAX_TILES = 200
"""Tiles that are kept; of more, those that were not asked for longest go."""
MAX_BYTES = 300_000
"""Limit in bytes of a tile as a page receives it."""

_disk = DiskThreads(4)


class TileShelf:
    """The tiles of one map.

    Args:
        address: see `webviz.data.tiles.open_tiles`.
        timeout_s: that a server has for each tile.
    """

    def __init__(self, address: str, timeout_s: float) -> None:
        self.address = address
        self.problem = ""
        """Reason why the newest tile could not be read, a sentence or ""."""
        self.attribution = ""
        self.timeout_s = timeout_s
        self._lock = threading.Lock()
        self._tiles: OrderedDict[Tile, Mapping[str, Any]] = OrderedDict()
        self._queue: OrderedDict[Tile, None] = OrderedDict()
        self._source: TileSource | None = None
        self._is_busy = False

    def want(self, tiles: Iterable[Tile]) -> None:
        """Read these tiles as soon as possible, in place of those that are still waited for."""
        with self._lock:
            self._queue.clear()
            for tile in [each for each in tiles if is_tile(each)][:MAX_TILES]:
                if tile in self._tiles:
                    self._tiles.move_to_end(tile)
                else:
                    self._queue[tile] = None
            if self._is_busy or not self._queue or not self.address:
                return
            self._is_busy = True
        try:
            _disk.start(self._read)
        except OSError as error:
            self.problem = f"Tiles cannot be read: {error}."
            self._is_busy = False

    def parts(self) -> dict[str, Mapping[str, Any]]:
        """Return the tiles by level, column and row with slashes between; "" is none there."""
        with self._lock:
            return {"/".join(map(str, tile)): part for tile, part in self._tiles.items()}

    def _read(self) -> None:
        while True:
            with self._lock:
                if not self._queue:
                    self._is_busy = False
                    return
                tile, _ = self._queue.popitem(last=False)
            part = self._part(tile)
            with self._lock:
                self._tiles[tile] = part
                while len(self._tiles) > MAX_TILES:
                    self._tiles.popitem(last=False)

    def _part(self, tile: Tile) -> Mapping[str, Any]:
        """Return a tile for pages, an empty one if there is none."""
        try:
            if self._source is None:
                self._source = open_tiles(self.address, self.timeout_s)
                self.attribution = self._source.attribution
            content = self._source.read(*tile)
            if content is not None:
                decoded(content)  # browsers get nothing that is not an image
                if len(content) > MAX_BYTES:
                    raise TileError(f"A tile has {len(content)} bytes; the limit is {MAX_BYTES}.")
        except (TileError, OSError) as error:
            self.problem = str(error)
            content = None
        else:
            self.problem = ""
        return {"image": base64.b64encode(content or b"").decode()}


def is_tile(tile: Tile) -> bool:
    """Return whether there is such a place in Web Mercator."""
    zoom, x, y = tile
    return 0 <= zoom <= MAX_ZOOM and 0 <= x < 1 << zoom and 0 <= y < 1 << zoom


FIX, PATH = "sensor_msgs/msg/NavSatFix", "geographic_msgs/msg/GeoPath"
MAX_TOPICS = 8
MAX_POINTS = 5000
"""Places of a track."""
PER_PART = 250
"""Places that pages receive at once."""
STEP_DEG = 1e-6
"""Places nearer than this to the one before, 10 cm, are left out."""
MAX_ASKED = 128
"""Tiles that a page may ask for at once."""
NO_FIX = -1
"""`status.status` of a receiver that knows no position."""

Place = tuple[float, float]
"""Longitude and latitude in degrees."""


class _Track:
    """The places of one topic, in parts of which only the last one changes."""

    def __init__(self) -> None:
        self.parts: list[list[Place]] = []
        self.first = 0
        """Number of the first part."""
        self.invalid = 0
        """Messages without a place in succession."""
        self.newest: Place | None = None
        self._cache: dict[int, tuple[int, Mapping[str, Any]]] = {}

    def add(self, place: Place) -> None:
        """Go on to a place."""
        before, self.newest = self.newest, place
        if before and max(abs(before[0] - place[0]), abs(before[1] - place[1])) < STEP_DEG:
            return
        if not self.parts or len(self.parts[-1]) >= PER_PART:
            # The first place of a part is the last of the one before, so that no gap is drawn.
            self.parts.append([before] if before and self.parts else [])
        self.parts[-1].append(place)
        while len(self.parts) > MAX_POINTS // PER_PART:
            del self.parts[0]
            self.first += 1

    def segments(self) -> dict[int, Mapping[str, Any]]:
        """Return the parts by number; the same objects as before if they have not changed."""
        for number, part in enumerate(self.parts, self.first):
            entry = self._cache.get(number)
            if entry is None or entry[0] != len(part):
                flat = [round(degree, 7) for place in part for degree in place]
                self._cache[number] = len(part), {"places": flat}
        numbers = range(self.first, self.first + len(self.parts))
        self._cache = {number: self._cache[number] for number in numbers}
        return {number: part for number, (_, part) in self._cache.items()}


class OutdoorMap(Panel):
    """Tracks of satellite receivers, and paths of latitudes and longitudes, over map tiles."""

    title = "Outdoor map"
    icon = "map"
    opens = "below"
    module = "outdoor_map.js"

    topics: Annotated[
        list[str],
        msgspec.Meta(max_length=MAX_TOPICS),
        Prop(help="Topics with NavSatFix or GeoPath; empty for all, eight at most."),
    ] = msgspec.field(default_factory=list)
    object_uri: Annotated[
        str,
        Prop(
            help="Tiles: an .mbtiles or .pmtiles file, a folder, or an address with {z}, {x} and "
            "{y}. Servers must be allowed: WEBVIZ_TILE_SERVERS=https://tiles.example/",
        ),
    ] = ""
    timeout: Annotated[
        float, Prop(gt=0, le=60, unit="s", help="Time that a server has for each tile.")
    ] = 3.0
    window: Annotated[float, Prop(gt=0, le=86400, unit="s", help="Time read after a seek.")] = 600.0

    def __post_init__(self) -> None:
        """Begin without tracks."""
        self.types: dict[str, str] = {}
        self.tracks: dict[str, _Track] = {}
        self.refused: dict[str, str] = {}
        self.shelf = TileShelf("", 0.0)

    def build(self, ui: Ui, send: Send) -> None:
        """Show the map."""
        self.map = ui.widget("outdoor map", {}, self._ask)

    def subscriptions(self) -> Mapping[str, str]:
        """Return the topics of the tracks."""
        return {topic: self.types[topic] for topic in self.tracks if topic in self.types}

    def lookback(self, topic: str) -> Lookback:
        """Return the fixes of the window, the newest path."""
        if self.types.get(topic) == PATH:
            return Lookback(count=1)
        return Lookback(seconds=self.window)

    def take(self, topic: str, message: Any) -> None:
        """Add a fix to its track, or show another path."""
        if topic not in self.tracks:
            return
        self.refused.pop(topic, None)
        if self.types.get(topic) == PATH:
            track = self.tracks[topic] = _Track()
            positions = [each.pose.position for each in message.poses[:MAX_POINTS]]
        else:
            track, positions = self.tracks[topic], [message]
            if message.status.status <= NO_FIX:
                track.invalid += 1
                return
        for each in positions:
            if _is_shown(each.latitude, each.longitude):
                track.add((each.longitude, each.latitude))
                track.invalid = 0
            else:
                track.invalid += 1

    def refuse(self, topic: str, reason: str) -> None:
        """Show why a topic cannot be read."""
        self.refused[topic] = reason

    def start_over(self) -> None:
        """Forget all places."""
        self.tracks = {topic: _Track() for topic in self.tracks}

    def show(self, offers: Mapping[str, Offer]) -> None:
        """Show the tracks and the tiles."""
        all_types = types_of(offers)
        self.types = {topic: type_ for topic, type_ in all_types.items() if type_ in (FIX, PATH)}
        chosen = list(dict.fromkeys(self.topics or sorted(self.types)))[:MAX_TOPICS]
        self.tracks = {topic: self.tracks.get(topic) or _Track() for topic in chosen}
        if (self.shelf.address, self.shelf.timeout_s) != (self.object_uri, self.timeout):
            self.shelf = TileShelf(self.object_uri, self.timeout)
        parts = {f"tile/{name}": part for name, part in self.shelf.parts().items()}
        tracks: list[Mapping[str, Any]] = []
        for index, (topic, track) in enumerate(self.tracks.items()):
            segments = track.segments()
            parts |= {f"track/{index}/{number}": part for number, part in segments.items()}
            is_path = self.types.get(topic) == PATH
            newest = None if is_path or track.newest is None else list(track.newest)
            span = [track.first, track.first + len(segments)]
            tracks.append({"topic": topic, "is_path": is_path, "parts": span, "newest": newest})
        values = {"address": self.object_uri, "credit": self.shelf.attribution, "tracks": tracks}
        self.map.show(values | {"problem": self._problem(chosen)}, parts)

    def _problem(self, topics: Sequence[str]) -> str:
        if not topics:
            return "No publisher of NavSatFix or GeoPath. Start the node of the receiver."
        for topic in topics:
            track = self.tracks[topic]
            if topic not in self.types:
                return f"No publisher of NavSatFix or GeoPath on {topic}. Start it."
            if reason := self.refused.get(topic):
                return reason
            if track.invalid:
                invalid = counted(track.invalid, "message")
                return f"{topic}: {invalid} without a place on the map. Check the receiver."
        if not any(track.parts for track in self.tracks.values()):
            return f"No place yet on {', '.join(topics)}."
        if not self.object_uri:
            return "No tiles are chosen. Enter a file, folder or address below, in Properties."
        return self.shelf.problem

    def _ask(self, value: Any, browser: int | None) -> None:
        """Read the tiles that a page shows."""
        tiles = msgspec.convert(value, list[tuple[int, int, int]])
        self.shelf.want(tiles[:MAX_ASKED])


def _is_shown(latitude: float, longitude: float) -> bool:
    """Return whether a place in degrees is on the map; False for NaN."""
    return abs(latitude) <= MAX_LATITUDE and abs(longitude) <= 180.0 and math.isfinite(longitude)
