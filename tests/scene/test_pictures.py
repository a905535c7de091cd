"""Pictures in the scene, as a real browser draws them."""

from __future__ import annotations

import numpy as np

from tests.scene.conftest import View, floats
from webviz.api.nodes import Image, Lines, Pose
from webviz.api.views import Orbit, TopDownOrtho
from webviz.scene.schemes import BACKGROUND

COLOR = (200, 100, 50)
RED, GREEN, BLUE = (255, 0, 0), (0, 255, 0), (0, 0, 255)


def checker() -> np.ndarray:
    """4 x 4 cells of COLOR; (0, 0) red, the last of row 0 green, of column 0 blue; one clear."""
    rgba = np.full((4, 4, 4), 255, np.uint8)
    rgba[..., :3] = COLOR
    rgba[0, 0, :3], rgba[0, 3, :3], rgba[3, 0, :3] = RED, GREEN, BLUE
    rgba[3, 3] = 0
    return rgba


def test_cell_0_0_of_a_picture_is_at_its_origin_with_columns_along_x_and_rows_along_y(
    view: View,
) -> None:
    view.scene.upsert("map", "grid", Image(checker(), 4.0, 4.0))
    view.scene.set_pose("map", Pose((-1.0, -2.0, 0.0)))
    view.show()
    view.wait_for(lambda: view.draw(1) or view.color_at((-0.5, -1.5, 0.0)) == RED)
    assert view.color_at((2.5, -1.5, 0.0)) == GREEN
    assert view.color_at((-0.5, 1.5, 0.0)) == BLUE
    assert view.color_at((2.5, 1.5, 0.0)) == BACKGROUND
    assert view.color_at((1.0, 0.0, 0.0)) == COLOR


def test_the_cells_of_a_picture_are_sharp(view: View) -> None:
    view.scene.upsert("map", "grid", Image(checker(), 4.0, 4.0))
    view.show()
    view.wait_for(lambda: view.draw(1) or view.color_at((0.5, 0.5, 0.0)) == RED)
    row, left = view.row_column((0.2, 0.5, 0.0))
    _, right = view.row_column((1.8, 0.5, 0.0))
    colors = {tuple(color) for color in view.pixels()[row, left:right].tolist()}
    assert colors == {RED, COLOR}


def test_a_picture_of_several_tiles_is_seamless(view: View) -> None:
    rgba = np.full((8, 9000, 4), (*COLOR, 255), np.uint8)
    view.scene.set_pose("map", Pose((-3.0, -1.0, 0.0)))
    view.scene.upsert("map", "grid", Image(rgba, 6.0, 2.0))
    view.show()
    view.wait_for(lambda: view.draw(1) or view.color_at((2.9, 0.0, 0.0)) == COLOR)
    row, left = view.row_column((-2.9, 0.0, 0.0))
    _, right = view.row_column((2.9, 0.0, 0.0))
    assert (view.pixels()[row, left:right] == COLOR).all()


def test_a_picture_that_changes_never_blanks(view: View) -> None:
    cells = np.full((64, 64, 4), (0, 0, 255, 255), np.uint8)
    view.scene.set_pose("map", Pose((-1.0, -1.0, 0.0)))
    view.scene.upsert("map", "grid", Image(cells, 2.0, 2.0))
    view.show()
    view.wait_for(lambda: view.draw(1) or view.color_at((0.0, 0.0, 0.0)) == BLUE)
    row, column = view.row_column((0.0, 0.0, 0.0))
    view.evaluate(
        """([column, row]) => {
          const {canvas, scene} = window.__viserMutable;
          const gl = canvas.getContext("webgl2");
          const pixel = new Uint8Array(4);
          const before = scene.onAfterRender;
          window.seen = [];
          window.stop = () => { scene.onAfterRender = before };
          scene.onAfterRender = (...args) => {
            before.apply(scene, args);
            gl.readPixels(column, canvas.height - 1 - row, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
            window.seen.push([...pixel].slice(0, 3));
          };
        }""",
        [column, row],
    )
    for green in range(10, 210, 10):
        cells = cells.copy()
        cells[..., 1] = green
        view.scene.upsert("map", "grid", Image(cells, 2.0, 2.0))
        view.show()
    view.wait_for(lambda: view.draw(1) or view.color_at((0.0, 0.0, 0.0)) == (0, 200, 255))
    colors = view.evaluate("() => { stop(); return seen; }")
    assert len(colors) > 20
    assert {(red, blue) for red, _, blue in colors} == {(0, 255)}


def greenness(view: View) -> list[int]:
    """Return the green along a line that crosses a red picture and passes by the camera."""
    view.wait_for(lambda: view.draw(1) or view.color_at((0.0, 0.5, 0.0)) == RED)
    pixels = view.pixels()
    places = [view.row_column((x, 0.0, 0.0)) for x in np.linspace(-1.0, 1.0, 9).tolist()]
    return [int(pixels[y - 1 : y + 2, x - 1 : x + 2, 1].max()) for y, x in places]


def test_lines_in_the_plane_of_a_picture_are_drawn_over_it_from_everywhere(view: View) -> None:
    view.scene.upsert("grid", "line", Lines(floats(((-30, 0, 0), (30, 0, 0))), GREEN))
    view.scene.set_pose("map", Pose((-3.0, -3.0, 0.0)))
    view.scene.upsert("map", "grid", Image(np.full((8, 8, 4), (*RED, 255), np.uint8), 6.0, 6.0))
    for position in ((4.0, -6.0, 2.0), (0.0, -0.01, 8.0), (-20.0, -15.0, 10.0)):
        view.look(position, (0.0, 0.0, 0.0))
        assert min(greenness(view)) > 100
    view.scene.cameras.show(TopDownOrtho(scale=30.0))
    view.show()
    assert min(greenness(view)) > 100
    view.scene.cameras.show(Orbit())


def test_a_picture_a_centimetre_above_a_line_hides_it(view: View) -> None:
    view.scene.upsert("grid", "line", Lines(floats(((-30, 0, -0.01), (30, 0, -0.01))), GREEN))
    view.scene.set_pose("map", Pose((-3.0, -3.0, 0.0)))
    view.scene.upsert("map", "grid", Image(np.full((8, 8, 4), (*RED, 255), np.uint8), 6.0, 6.0))
    view.look((1.0, -1.0, 4.0), (0.0, 0.0, 0.0))
    assert greenness(view) == [0] * 9


def test_the_higher_layer_of_two_images_in_one_plane_is_on_top_from_everywhere(
    view: View,
) -> None:
    for name, color, corner, layer in (("costmap", BLUE, -1.0, 3), ("map", RED, -2.0, -100_000)):
        view.scene.set_pose(name, Pose((corner, corner, 0.0)))
        cells = np.full((8, 8, 4), (*color, 255), np.uint8)
        view.scene.upsert(name, "grid", Image(cells, 2.0, 2.0, layer))
        view.scene.flush()
    for position in ((0.0, -0.01, 10.0), (6.0, 6.0, 3.0), (-6.0, -6.0, 3.0)):
        view.look(position, (0.0, 0.0, 0.0))
        view.wait_for(lambda: view.draw(1) or view.color_at((0.5, 0.5, 0.0)) == BLUE)
        assert view.color_at((-0.5, -0.5, 0.0)) == BLUE
        assert view.color_at((-1.5, -1.5, 0.0)) == RED
