"""The AerialMap display."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated, TypeVar

import msgspec
import numpy as np

from webviz import Context, Details, Display, Hit, Image, Lookback, Pose, Prop, Sample, Topic
from webviz.data.disk import DiskThreads
from webviz.data.geo import MAX_LATITUDE, MAX_ZOOM, Geodetic, TilePlane, to_utm
from webviz.data.tiles import Cells, TileError, TileSource, decoded, open_tiles
from webviz.data.words import counted
from webviz_displays.map.display import BEHIND
from webviz_displays.outdoors.fixes import FIX, fault_of, place_of
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.properties import opaque

AT_ONCE = 2
"""Tiles that are loaded at once: half of the threads that all displays share."""
MARGIN_S = 5.0
"""Margin in seconds for the disk, besides the time that a server has."""
MAX_FAILURES = 3
"""Tiles that fail one after the other until the rest is not tried: a server may be down."""

Tile = tuple[int, int, int]
"""Zoom, column, row."""

T = TypeVar("T")

_disk = DiskThreads(16)


class TileLoading(msgspec.Struct):
    """The tiles of one source.

    Args:
        address: of the source.
        timeout_s: for each answer of a server.
        source: once it is open.
        tiles: pixels of those that are needed and loaded; None where the map has none.
        failures: why tiles could not be loaded.
    """

    address: str
    timeout_s: float
    source: TileSource | None = None
    tiles: dict[Tile, Cells | None] = msgspec.field(default_factory=dict)
    failures: dict[Tile, str] = msgspec.field(default_factory=dict)

    def load(self, tiles: Sequence[Tile], ctx: Context) -> bool:
        """Go on with loading what is wanted, in this order, and forget the rest.

        Returns:
            Whether everything wanted has been tried.

        Raises:
            TileError: the source cannot be opened.
        """
        if self.source is None:
            self.source = ctx.background(
                ("tiles", self.address, self.timeout_s), _open, self.address, self.timeout_s
            )
            if self.source is None:
                return False
        needed = set(tiles)
        self.tiles = {tile: cells for tile, cells in self.tiles.items() if tile in needed}
        self.failures = {tile: why for tile, why in self.failures.items() if tile in needed}
        pending = 0
        for tile in tiles:
            if tile in self.tiles or tile in self.failures:
                continue
            if pending == AT_ONCE or len(self.failures) >= MAX_FAILURES:
                break
            work = (self.source, tile, self.timeout_s)
            try:
                loaded = ctx.background((self.address, tile), _load, *work)
            except TileError as error:
                self.failures[tile] = str(error)
                continue
            if loaded is None:
                pending += 1
            else:
                (self.tiles[tile],) = loaded
        return not pending


def _open(address: str, timeout_s: float) -> TileSource:
    return _within(timeout_s, address, lambda: open_tiles(address, timeout_s))


def _load(source: TileSource, tile: Tile, timeout_s: float) -> tuple[Cells | None]:
    """Return the pixels of a tile in a tuple, as None means that it is still being loaded."""
    content = _within(timeout_s, "The map", lambda: source.read(*tile))
    return (None if content is None else decoded(content),)


def _within(timeout_s: float, name: str, work: Callable[[], T]) -> T:
    """Return the result of work that a disk or server may never answer."""
    try:
        return _disk.within(timeout_s + MARGIN_S, work)
    except (OSError, RuntimeError) as error:
        raise TileError(f"{name} cannot be read: {error}.") from error


MAX_BLOCKS = 8
"""17 x 17 tiles, 76 MB of pixels (the limit of rviz_satellite)."""


class _State(msgspec.Struct):
    """Kept between fixes.

    Args:
        loading: of the chosen tiles.
        nodes: nodes of tiles by number, with the opacity and size for which they were made.
        look: those.
    """

    loading: TileLoading | None = None
    nodes: dict[Tile, Image] = msgspec.field(default_factory=dict)
    look: tuple[object, ...] = ()


class AerialMap(Display):
    """Map tiles, such as aerial pictures, around a satellite receiver."""

    rviz = "rviz_satellite/AerialMap"
    icon = "map"

    topic: Annotated[Topic, FIX, Prop(help="Topic of the receiver's fixes.")] = Topic("/gps/fix")
    alpha: Annotated[Alpha, Prop(help="Opacity of the map; 0 is invisible.")] = 0.7
    draw_behind: Annotated[bool, Prop(help="Draw below all maps, whatever the order.")] = False
    object_uri: Annotated[
        str,
        Prop(
            rviz="Object URI",
            help="Tiles: an .mbtiles or .pmtiles file, a folder, or an address with {z}, {x} and "
            "{y}. Servers must be allowed: WEBVIZ_TILE_SERVERS=https://tiles.example/",
        ),
    ] = ""
    zoom: Annotated[
        int, Prop(ge=0, le=MAX_ZOOM, help="Level of detail; a tile of level 16 is 611 m wide.")
    ] = 16
    blocks: Annotated[
        int, Prop(ge=0, le=MAX_BLOCKS, help="Number of tiles to each side of the receiver.")
    ] = 3
    timeout: Annotated[
        float, Prop(gt=0, le=60, unit="s", help="Time that a server has for each tile.")
    ] = 3.0

    def new_state(self) -> _State:
        """Return the state before the first tile."""
        return _State()

    def lookback(self, name: str) -> Lookback:
        """Return the newest fix."""
        return Lookback(count=1)

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the tiles around the newest fix; x of the fixed frame is east, y is north."""
        if not samples:
            return
        fault = fault_of(samples[-1].message)
        if fault:
            ctx.error("Fix", fault)
            return
        place = place_of(samples[-1].message)
        if abs(place.latitude) > MAX_LATITUDE:
            ctx.error("Fix", f"Map tiles end at a latitude of {MAX_LATITUDE:.2f}°.")
            return
        if not self.object_uri:
            ctx.warn("Tiles", "No tiles are chosen. Enter a file, folder or address in Object URI.")
            return
        if self.alpha == 0:
            ctx.warn("Tiles", "Invisible: alpha is 0. Increase it to show the map.", opaque())
            return
        # Places of tiles depend on the tile around the fix only: a new fix moves one group.
        here = TilePlane(place, self.zoom)
        column, row = (int(each) for each in here.center)
        plane = TilePlane(_middle(column, row, here), self.zoom)
        tiles = {(self.zoom, x % plane.count, y): (x, y) for x, y in plane.around(self.blocks)}
        state: _State = ctx.state
        loading = state.loading
        if loading is None or (loading.address, loading.timeout_s) != (
            self.object_uri,
            self.timeout,
        ):
            loading = state.loading = TileLoading(self.object_uri, self.timeout)
        try:
            is_complete = loading.load(list(tiles), ctx)
        except TileError as error:
            ctx.error("Tiles", str(error))
            return
        self._draw(tiles, plane, here, samples[-1].pose, ctx)
        self._report(loading, is_complete, len(tiles), ctx)

    def _draw(
        self,
        layout: dict[Tile, tuple[int, int]],
        plane: TilePlane,
        here: TilePlane,
        pose: Pose,
        ctx: Context,
    ) -> None:
        """Draw the tiles that are loaded, so that the fix lies where its frame is."""
        state: _State = ctx.state
        assert state.loading is not None
        width, height = plane.size
        (x, y), (middle_x, middle_y) = here.center, plane.center
        east, north, up = pose.position
        offset = (east - (x - middle_x) * width, north - (middle_y - y) * height, up)
        group = ctx.follow(None, offset=Pose(offset), key="tiles")
        layer = ctx.order - (BEHIND if self.draw_behind else 0)
        look = (self.object_uri, self.alpha, width, height, layer)
        if state.look != look:
            state.look, state.nodes = look, {}
        tiles = state.loading.tiles
        state.nodes = {tile: node for tile, node in state.nodes.items() if tile in tiles}
        for tile, at in layout.items():
            cells = tiles.get(tile)
            if cells is None:
                continue
            if tile not in state.nodes:
                state.nodes[tile] = Image(_faded(cells, self.alpha), width, height, layer)
            key = "/".join(map(str, tile))
            group.add(key, state.nodes[tile], Pose((*plane.corner(*at), 0.0)))

    def _report(self, loading: TileLoading, is_complete: bool, count: int, ctx: Context) -> None:
        count_shown = sum(cells is not None for cells in loading.tiles.values())
        credit = loading.source.attribution if loading.source else ""
        ctx.attribution = credit if count_shown else ""
        if not is_complete:
            ctx.warn("Tiles", f"Loading: {len(loading.tiles)} of {counted(count, 'tile')}.")
        elif loading.failures:
            reason = next(iter(loading.failures.values()))
            ctx.warn("Tiles", f"Showing {count_shown} of {counted(count, 'tile')}. {reason}")
        elif not count_shown:
            ctx.warn(
                "Tiles",
                f"The map has no tiles of level {self.zoom} here. Choose another zoom or map.",
            )
        else:
            ctx.ok("Tiles", f"Showing {counted(count_shown, 'tile')}.")

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the tile, and the newest fix."""
        fix = place_of(hit.samples[-1].message)
        values = {"Latitude": f"{fix.latitude:.7f}°", "Longitude": f"{fix.longitude:.7f}°"}
        if (utm := to_utm(*fix[:2])) is not None:
            values["UTM"] = str(utm)
        return Details(f"Tile {hit.key}", values)


def _middle(column: int, row: int, plane: TilePlane) -> Geodetic:
    """Return the middle of a tile."""
    y = np.pi * (1.0 - 2.0 * (row + 0.5) / plane.count)
    latitude = float(np.degrees(np.arctan(np.sinh(y))))
    return Geodetic(latitude, (column + 0.5) / plane.count * 360.0 - 180.0)


def _faded(cells: Cells, alpha: float) -> Cells:
    if alpha >= 1.0:
        return cells
    faded = cells.copy()
    faded[..., 3] = np.round(cells[..., 3] * np.float32(alpha))
    return faded
