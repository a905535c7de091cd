"""The page that `webviz` and `webviz demo` serve, until Ctrl-C."""

import contextlib
import functools
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from webviz.api.registry import display_types
from webviz.files import config as config_file
from webviz.files import opening
from webviz.files.config import Config
from webviz.files.config.overrides import override
from webviz.shell.app.viewer import Viewer
from webviz.shell.cli.convert import tell
from webviz.shell.cli.ending import INTERRUPTED, Stop, say
from webviz.shell.cli.viewing_options import LOCAL, ViewingOptions

DEMO = Path(__file__).parent / "demo.yaml"


def serve(
    options: ViewingOptions, ros: Sequence[str], stop: Stop, standard: Path | None = None
) -> int:
    """Show the page until the program is to end.

    Args:
        options: what to show and where.
        ros: arguments for ROS.
        stop: asked when to end.
        standard: the config if none is given.

    Returns:
        The exit status.

    Raises:
        Error: it cannot be shown; one sentence.
    """
    read = functools.cache(functools.partial(_config, options, standard))
    if options.display_config is not None and not options.plugin:
        # Mistakes are reported before imports that take seconds. With plug-ins the viewer reads it,
        # after it has loaded the displays that the file may name.
        read(options.display_config)
    options.allow_meshes()
    _import_slow_parts()
    is_shown = False
    if stop.hold():
        with Viewer(
            options.display_config,
            read=read,
            host=options.host,
            port=options.port,
            allow_hosts=options.allow_host,
            fixed_frame=options.fixed_frame,
            ros_args=ros,
            plugins=options.plugin,
            autosave=_last_session() if options.autosave else None,
            config_folders=options.config_folder,
        ) as viewer:
            stop.then(viewer.stop)
            is_shown = not stop.is_asked
            if is_shown:
                _announce(options, viewer)
                viewer.wait()
    if is_shown:
        say("\nwebviz: stopped.")
        return 0
    say("webviz: interrupted.")
    return INTERRUPTED


def _import_slow_parts() -> None:
    """Import what a viewer needs, so that it is made quickly and a signal meets few half made."""
    display_types()
    import webviz.edges.gui
    import webviz.edges.scene
    import webviz.shell.pictures.snapshots

    with contextlib.suppress(ImportError):  # reported when it is needed
        import webviz.edges.ros.node  # noqa: F401


def _announce(options: ViewingOptions, viewer: Viewer) -> None:
    print(f"webviz: open {viewer.url} (Ctrl-C ends it)")
    if options.host not in (LOCAL, "localhost", "::1"):
        names = ", ".join(options.allow_host) or "the address given with --host only"
        print(
            f"webviz: everyone who reaches {options.host}:{viewer.port} can watch and change "
            f"this viewer; browsers must address it as: {names}."
        )
    sys.stdout.flush()


def _last_session() -> Path:
    """Where the last session is kept, by the XDG base directory specification."""
    home = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(home) / "webviz" / "last.yaml"


def _config(options: ViewingOptions, standard: Path | None, path: Path | None) -> Config:
    """What to begin with; `path` is what somebody asked for, `standard` what the command shows."""
    if path is None and options.autosave and _last_session().exists():
        path = _last_session()
    path = path or standard
    config = config_file.standard() if path is None else opening.load(path)
    if path is not None:
        tell(path, config.report)
    return override(config, options.set)
