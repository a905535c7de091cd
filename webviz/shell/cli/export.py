"""`webviz export`: writes a part of a bag as one HTML file."""

# Without `from __future__ import annotations`, see `webviz.shell.cli.options`.
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from webviz.shell.cli.comparison_options import ComparisonOptions
from webviz.shell.cli.ending import INTERRUPTED, end_in_time, on_signal, say_end
from webviz.shell.cli.options import ConfigOptions, File, Size
from webviz.shell.cli.screenshot_options import Seconds, Time
from webviz.shell.cli.terminal import progress, say, warn

EXAMPLES = """\
Examples:
  webviz export run.mcap -d lab.yaml -o run.html
  webviz export run.mcap -d lab.yaml --from 10 --to 40 -o run.html
  webviz export today.mcap --ghost yesterday.mcap -o both.html

"""

app = App("export", help_epilogue=EXAMPLES)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ExportOptions(ConfigOptions, ComparisonOptions):
    """Options for the file to make."""

    output: Annotated[File, Parameter(alias="-o")]
    """HTML file to write; it needs neither a server nor a network."""
    first: Annotated[Time, Parameter(name="--from")] = "start"
    """Beginning: seconds from the start, a Unix time, `start` or `end`."""
    last: Annotated[Time, Parameter(name="--to")] = "end"
    """End, in the same ways."""
    at: Time | None = None
    """Moment that the file shows when it is opened (default: that of --from)."""
    rate: Annotated[Seconds, Parameter(metavar="HZ")] = 10.0
    """Frames per second of the bag."""
    max_size: Annotated[Size, Parameter(metavar="SIZE")] = 50_000_000
    """Limit of the file, such as 50MB: clouds are thinned, and large data shown less often."""


def _check(bag: Path, *, options: ExportOptions) -> None:
    """Raise ValueError for an invalid combination of arguments."""
    options.check_comparison(has_bag=True)


@app.default(validator=_check)
def export(
    bag: Annotated[Path, Parameter(metavar="BAG", help="MCAP or db3 file, or rosbag2 folder.")],
    *,
    options: ExportOptions,
) -> int:
    """Write the file; the exit status."""
    on_signal(_interrupt)
    try:
        return _make(bag, options)
    except KeyboardInterrupt:
        say_end("webviz: interrupted; nothing was written.")
        return INTERRUPTED


def _make(bag: Path, options: ExportOptions) -> int:
    import contextlib

    from webviz.engine.pipeline import plugins
    from webviz.shell.export.export import export as write
    from webviz.shell.export.order import ExportOrder

    options.allow_meshes()
    for path in options.plugin:
        plugins.load(path)
    with contextlib.closing(options.beside(bag)) as source:
        config = options.config_of(source)
        config_path = options.display_config
        order = ExportOrder(
            config,
            source,
            str(bag),
            config_path.name if config_path else "",
            options.first,
            options.last,
            options.rate,
            options.max_size,
            options.at,
        )
        written = write(order, options.output, lambda share: progress("webviz: exporting", share))
        for warning in source.warnings:
            warn(f"webviz: {bag}: {warning}")
    for note in written.notes:
        warn(f"webviz: to stay below --max-size: {note}")
    if written.bytes > options.max_size:
        warn(
            "webviz: the file is larger than --max-size, even without everything large. "
            "Choose a shorter span, or fewer displays."
        )
    size, page = (f"{count / 1e6:.1f} MB" for count in (written.bytes, written.client_bytes))
    say(
        f"webviz: wrote {options.output}: {written.seconds:g} s, {written.frames} frames, {size} "
        f"({page} of it the page)."
    )
    return 0


def _interrupt() -> None:
    end_in_time()
    raise KeyboardInterrupt
