"""The page that `webviz` and `webviz demo` serve, until Ctrl-C."""

import functools
import os
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

from webviz import config as config_file
from webviz.app.viewer import Viewer
from webviz.cli.convert import tell
from webviz.cli.viewing import LOCAL, ViewingOptions
from webviz.config import Config
from webviz.config.overrides import override

DEMO = Path(__file__).parent / "demo.yaml"


def serve(options: ViewingOptions, ros: Sequence[str], standard: Path | None = None) -> None:
    """Show the page until Ctrl-C or SIGTERM; `standard` is the config if none is given."""
    options.allow_meshes()
    with Viewer(
        options.display_config,
        read=functools.partial(_config, options, standard),
        host=options.host,
        port=options.port,
        allow_hosts=options.allow_host,
        fixed_frame=options.fixed_frame,
        ros_args=ros,
        plugins=options.plugin,
        autosave=_last_session() if options.autosave else None,
        config_folders=options.config_folder,
    ) as viewer:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: viewer.stop())
        _announce(options, viewer)
        viewer.wait()
    print("\nwebviz: stopped.")


def _announce(options: ViewingOptions, viewer: Viewer) -> None:
    print(f"webviz: open {viewer.url} (Ctrl-C ends it)")
    if options.host not in (LOCAL, "localhost", "::1"):
        names = ", ".join(options.allow_host) or "the address given with --host only"
        print(
            f"webviz: whoever reaches {options.host}:{viewer.port} can watch and change this "
            f"viewer; browsers must address it as: {names}."
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
    config = config_file.standard() if path is None else config_file.load(path)
    if path is not None:
        tell(path, config.report)
    return override(config, options.set)
