"""Fixtures for visual tests of any package; see displays/docs/testing/README.md.

pytest imports this module whenever webviz is installed, so fixtures import the rest on demand.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from webviz.api.display import Display
    from webviz.api.views import View
    from webviz.files.config import Config
    from webviz.shell.testing.bench import DisplayBench
    from webviz.shell.testing.harness import Harness
    from webviz.shell.testing.live import LiveViewer
    from webviz.shell.testing.pictures import SnapshotFixture
    from webviz.shell.testing.recording import RecordingScene
    from webviz.shell.testing.shared_renderer import SharedRenderer, Size

SIZE = (400, 300)
"""Width and height of pictures in pixels."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Register the options."""
    parser.getgroup("webviz", "visual tests of robots").addoption(
        "--update-pictures",
        action="store_true",
        help="create missing reference pictures and replace outdated ones; "
        "look at each before committing",
    )
    parser.addini(
        "webviz_pictures",
        "folder of reference pictures below the root; default: `pictures` next to each test file",
    )
    parser.addini(
        "webviz_output",
        "folder below the root for pictures that differ; default: picture_output",
        default="picture_output",
    )
    parser.addini(
        "webviz_each_display",
        "whether every display must be visible in each picture",
        type="bool",
        default=False,
    )


@pytest.fixture(scope="session")
def webviz_renderer() -> Iterator[SharedRenderer]:
    """Share one browser for all pictures, launched for the first one."""
    from webviz.shell.testing.shared_renderer import SharedRenderer

    shared_renderer = SharedRenderer()
    yield shared_renderer
    shared_renderer.close()


@pytest.fixture(scope="session")
def webviz_domain() -> Iterator[int]:
    """Reserve a ROS domain that is unused on this machine, also for processes started by tests."""
    from webviz.shell.testing.domain import isolated_domain

    with isolated_domain() as domain:
        yield domain


@pytest.fixture
def webviz_harness(
    webviz_renderer: SharedRenderer, request: pytest.FixtureRequest
) -> Iterator[Callable[..., Harness]]:
    """Create viewers without ROS: `webviz_harness("my.yaml")` or `webviz_harness(Grid(), Map())`.

    Keyword arguments: `view`, `fixed_frame`, `size` of pictures.
    """
    with contextlib.ExitStack() as stack:

        def make(*what: str | Path | Display, **options: Any) -> Harness:
            from webviz.shell.testing.harness import Harness

            config, scene, snapshot = _set_up(webviz_renderer, request, what, **options)
            harness = Harness(config, scene, snapshot)
            stack.callback(webviz_renderer.forget, scene)
            stack.callback(harness.close)
            return harness

        yield make


@pytest.fixture
def webviz_bench() -> Iterator[Callable[..., DisplayBench]]:
    """Create displays at work without ROS and browser: `webviz_bench(Grid(), fixed_frame="map")`.

    They receive messages and draw nodes and statuses when their test says so.
    """
    from webviz.engine.pipeline.background import Workers
    from webviz.shell.testing.bench import DisplayBench

    workers = Workers(lambda: None)
    yield lambda display, **options: DisplayBench(display, workers, **options)
    workers.close()


@pytest.fixture
def webviz_viewer(
    webviz_renderer: SharedRenderer, webviz_domain: int, request: pytest.FixtureRequest
) -> Iterator[Callable[..., LiveViewer]]:
    """Create viewers on an isolated ROS domain: `webviz_viewer("my.yaml", simulator=True)`.

    Keyword arguments: `view`, `fixed_frame`, `size` of pictures, `simulator` (True or the
    parameters of a simulated robot).
    """
    with contextlib.ExitStack() as stack:

        def make(
            *what: str | Path | Display,
            simulator: bool | Mapping[str, Any] = False,
            **options: Any,
        ) -> LiveViewer:
            from webviz.shell.testing.live import LiveViewer

            config, scene, snapshot = _set_up(webviz_renderer, request, what, **options)
            parameters = None if simulator is False else {} if simulator is True else simulator
            viewer = LiveViewer(config, scene, snapshot, webviz_domain, parameters)
            stack.callback(webviz_renderer.forget, scene)
            stack.callback(viewer.close)
            return viewer

        yield make


def _set_up(
    shared_renderer: SharedRenderer,
    request: pytest.FixtureRequest,
    what: tuple[str | Path | Display, ...],
    view: View | None = None,
    fixed_frame: str | None = None,
    size: Size = SIZE,
) -> tuple[Config, RecordingScene, SnapshotFixture]:
    """Return the config, scene and snapshots of a viewer."""
    from webviz.shell.testing.pictures import ReferenceImages, SnapshotFixture
    from webviz.shell.testing.recording import RecordingScene

    config = _config(what, request.path.parent)
    if fixed_frame is not None:
        config.settings.fixed_frame = fixed_frame
    options, root = request.config, request.config.rootpath
    pictures = str(options.getini("webviz_pictures"))
    references = ReferenceImages(
        root / pictures if pictures else request.path.parent / "pictures",
        root / str(options.getini("webviz_output")),
        root,
        bool(options.getoption("--update-pictures")),
        bool(options.getini("webviz_each_display")),
        size,
    )
    scene = RecordingScene()
    return (
        config,
        scene,
        SnapshotFixture(scene, shared_renderer, references, view or config.settings.view),
    )


def _config(what: tuple[str | Path | Display, ...], folder: Path) -> Config:
    """Return the config of a file, relative to `folder`, or of displays."""
    from webviz.files import config, opening

    if not what:
        return config.standard()
    if isinstance(what[0], str | Path):
        return opening.load(folder / what[0])
    return config.Config(displays=list(what))  # pyright: ignore[reportArgumentType]
