import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike
from PIL import Image
from worlds import draw_world

from webviz_sim.options import BUILDING
from webviz_sim.pose import Pose2D
from webviz_sim.world import WorldError, load_world

MAPS = Path(__file__).parents[2] / "../shared/data/maps"

ENTRIES = {
    "image": "map.png",
    "resolution": "0.5",
    "origin": "[1.0, 2.0, 0.0]",
    "negate": "0",
    "occupied_thresh": "0.65",
    "free_thresh": "0.25",
}


@pytest.fixture
def write(tmp_path: Path) -> Callable[..., Path]:
    """Write a map; an entry given as None is left out."""

    def make(pixels: ArrayLike | None, pixel_mode: str = "L", **changes: Any) -> Path:
        if pixels is not None:
            array = np.array(pixels, dtype=np.uint8)
            image = Image.frombytes(pixel_mode, array.shape[1::-1], array.tobytes())
            image.save(tmp_path / "map.png")
        entries = {**ENTRIES, **changes}
        lines = [f"{key}: {value}" for key, value in entries.items() if value is not None]
        path = tmp_path / "map.yaml"
        path.write_text("\n".join(lines))
        return path

    return make


def test_trinary_mode_compares_strictly_with_both_thresholds(write: Callable[..., Path]) -> None:
    # Occupancies 1, 0.65098, 0.64706, 0.25098, 0.24706, 0.
    world = load_world(write([[0, 89, 90, 191, 192, 255]]))
    assert world.cells.tolist() == [[100, 100, -1, -1, 0, 0]]


def test_scale_mode_interpolates_between_the_thresholds(write: Callable[..., Path]) -> None:
    world = load_world(write([[0, 128, 191, 255]], mode="scale"))
    # (1 - 128/255 - 0.25) / 0.4 * 100 = 62.01, (1 - 191/255 - 0.25) / 0.4 * 100 = 0.25
    assert world.cells.tolist() == [[100, 62, 0, 0]]


def test_ties_of_scale_mode_are_decided_as_by_map_server(write: Callable[..., Path]) -> None:
    changes = {"mode": "scale", "occupied_thresh": 0.9, "free_thresh": 0.1}
    # 1 - 51/255 is 0.8, and (0.8 - 0.1) / (0.9 - 0.1) * 100 in doubles just above 87.5.
    assert load_world(write([[51]], **changes)).cells.tolist() == [[88]]
    assert load_world(write([[[51, 51, 51]]], "RGB", **changes)).cells.tolist() == [[88]]


def test_raw_mode_takes_pixels_up_to_100_as_they_are(write: Callable[..., Path]) -> None:
    world = load_world(write([[0, 1, 50, 100, 101, 205, 255]], mode="raw"))
    assert world.cells.tolist() == [[0, 1, 50, 100, -1, -1, -1]]


@pytest.mark.parametrize("negate", ["1", "true", "yes"])
def test_negate_exchanges_black_and_white(write: Callable[..., Path], negate: str) -> None:
    assert load_world(write([[0, 120, 255]], negate=negate)).cells.tolist() == [[0, -1, 100]]


def test_alpha_counts_as_a_fourth_channel_in_trinary_mode(write: Callable[..., Path]) -> None:
    pixels = [[[0, 0, 0, 255], [0, 0, 0, 0], [255, 255, 255, 255], [255, 255, 255, 0]]]
    # Shades 0.25, 0, 1, 0.75.
    assert load_world(write(pixels, "RGBA")).cells.tolist() == [[100, 100, 0, -1]]


def test_transparent_pixels_are_unknown_in_scale_mode(write: Callable[..., Path]) -> None:
    pixels = [[[0, 255], [0, 254], [255, 255], [255, 0]]]
    path = write(None, mode="scale")
    array = np.array(pixels, dtype=np.uint8)
    Image.frombytes("LA", (4, 1), array.tobytes()).save(path.parent / "map.png")
    assert load_world(path).cells.tolist() == [[100, -1, 0, -1]]


def test_colours_are_averaged(write: Callable[..., Path]) -> None:
    pixels = [[[255, 0, 0], [255, 255, 0], [0, 0, 0]]]  # occupancies 2/3, 1/3, 1
    assert load_world(write(pixels, "RGB")).cells.tolist() == [[100, -1, 100]]


def test_sixteen_bits_of_grey_are_read(write: Callable[..., Path]) -> None:
    path = write(None)
    array = np.array([[0, 65535]], dtype=np.uint16)
    Image.fromarray(array).save(path.parent / "map.png")
    assert load_world(path).cells.tolist() == [[100, 0]]


def test_the_last_row_of_the_image_is_the_first_of_the_grid(write: Callable[..., Path]) -> None:
    world = load_world(write([[0, 255], [255, 255], [255, 0]]))
    assert world.cells.tolist() == [[0, 100], [0, 0], [100, 0]]


def test_resolution_and_origin_with_yaw_place_the_cells(write: Callable[..., Path]) -> None:
    path = write([[255, 255]], origin="[1.0, 2.0, 1.5707963267948966]")
    world = load_world(path)
    # The middle of the second cell is 0.75 m along the grid's x, which points along the map's y.
    assert np.allclose(world.to_map(np.array([[1.5, 0.5]])), [[0.75, 2.75]])
    assert np.allclose(world.to_cells(np.array([[0.75, 2.75]])), [[1.5, 0.5]])
    assert np.allclose(world.to_grid(Pose2D(0.75, 2.75, math.pi)), (1.5, 0.5, math.pi / 2))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"image": "gone.png"}, "its image .*gone.png does not exist"),
        ({"image": "map.yaml"}, "its image .*map.yaml cannot be read"),
        ({"image": None}, "image must name a file"),
        ({"resolution": None}, "resolution is missing"),
        ({"resolution": "0"}, "resolution must be above 0"),
        ({"resolution": ".inf"}, "resolution must be a finite number"),
        ({"resolution": "fine"}, "resolution must be a finite number, not fine"),
        ({"origin": "[0, 0, .nan]"}, "origin must be three finite numbers"),
        ({"origin": "[0, 0, -nan]"}, "origin must be three finite numbers"),
        ({"origin": "[0, 0]"}, "origin must be three finite numbers"),
        ({"negate": "maybe"}, "negate must be 0 or 1, not maybe"),
        ({"mode": "ternary"}, "mode must be trinary, scale or raw, not ternary"),
        ({"free_thresh": None}, "free_thresh is missing"),
        ({"occupied_thresh": "[1]"}, "occupied_thresh must be a finite number"),
    ],
)
def test_a_wrong_entry_is_refused_in_one_sentence(
    write: Callable[..., Path], changes: Any, message: str
) -> None:
    path = write([[255]], **changes)
    with pytest.raises(WorldError, match=rf"^Invalid map .*map.yaml: {message}.*\.$"):
        load_world(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: [", "is not valid YAML"),
        ("just text", "expected the keys"),
        ("", "expected the keys"),
        ('<svg width="4m" viewBox="0 0 4 2"><rect/></svg>', "expected the keys"),
    ],
)
def test_an_invalid_map_is_refused_in_one_sentence(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "map.yaml"
    path.write_text(text)
    with pytest.raises(WorldError, match=message):
        load_world(path)


def test_a_missing_yaml_is_refused_in_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(WorldError, match=r"^Cannot read the map .*: No such file .*\.$"):
        load_world(tmp_path / "none.yaml")


def test_clearance_is_the_distance_to_the_nearest_wall_cell() -> None:
    world = draw_world("......\n..#...\n......\n......\n......", resolution=0.5)
    # The wall cell spans x 1.0 to 1.5 and y 1.5 to 2.0; the grid ends at x 3 and y 2.5.
    assert world.clearance(Pose2D(1.25, 1.1), 9.0) == pytest.approx(0.4)
    assert world.clearance(Pose2D(1.8, 1.1), 9.0) == pytest.approx(0.5)
    assert world.clearance(Pose2D(1.25, 1.1), 0.3) == 0.3
    assert world.clearance(Pose2D(1.2, 1.6), 9.0) == 0.0


def test_there_is_no_clearance_outside_the_world() -> None:
    world = draw_world("...\n...\n...")
    assert world.clearance(Pose2D(1.5, 0.25), 9.0) == pytest.approx(0.25)
    assert world.clearance(Pose2D(-5.0, 1.0), 9.0) == 0.0
    assert world.clearance(Pose2D(1e9, 1e9), 9.0) == 0.0


def test_the_bundled_building_is_12_by_8_metres() -> None:
    world = load_world(BUILDING)
    rows, columns = np.nonzero(world.occupied)
    assert world.resolution == 0.05
    assert np.ptp(columns) + 1 == 240
    assert np.ptp(rows) + 1 == 160


# The first pixel: white in TenByTen, else a grey which each map's own free_thresh decides about.
CORNERS = {"TenByTen": 0, "mac_1st_floor_final": 0, "tb3_sandbox": -1, "warehouse": -1}


@pytest.mark.parametrize("name", CORNERS)
def test_maps_in_the_wild_load_as_map_server_loads_them(name: str) -> None:
    path = MAPS / f"{name}.yaml"
    if not path.exists():
        pytest.skip(f"{path} is not there")
    world = load_world(path)
    with Image.open(path.with_suffix(".pgm")) as image:
        assert world.cells.shape == image.size[::-1]
    assert world.traversable.any()
    assert world.cells[-1, 0] == CORNERS[name]
