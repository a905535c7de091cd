"""`webviz recover`: writes what is whole of a damaged bag as a bag that every reader takes."""

# Without `from __future__ import annotations`, see `webviz.shell.cli.options`.
import contextlib
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from webviz.shell.cli.ending import INTERRUPTED, Stop, say_end, until_signal
from webviz.shell.cli.terminal import progress, warn

EXAMPLES = """\
Examples:
  webviz recover run                 write run_recovered, for a recorder that was killed
  webviz recover run.mcap -o whole   choose the folder

"""
SAID_EACH = 1000
"""Messages between two updates of the line of progress."""

app = App("recover", help_epilogue=EXAMPLES)


@app.default
def recover(
    bag: Annotated[Path, Parameter(metavar="BAG", help="MCAP or db3 file, or rosbag2 folder.")],
    *,
    output: Annotated[
        Path | None,
        Parameter(
            alias="-o",
            metavar="FOLDER",
            help="New folder (default: the name of the bag with _recovered).",
        ),
    ] = None,
) -> int:
    """Write the folder; the exit status."""
    path = output or bag.resolve().with_name(f"{bag.resolve().stem}_recovered")
    return until_signal(lambda stop: _copy(bag, path, stop))


def _copy(bag: Path, path: Path, stop: Stop) -> int:
    from webviz.api.errors import Error
    from webviz.data.recordings import RecordingError, open_recording
    from webviz.data.recordings.folder_writing import RecordingFolder
    from webviz.data.words import counted
    from webviz.sources.recording import library

    stop.hold()
    try:
        with contextlib.closing(open_recording(bag)) as recording:
            if recording.span_ns is None:
                raise Error(f"{bag} has no whole message. Record it again.")
            first_ns, last_ns = recording.span_ns
            folder = RecordingFolder(path, library())
            with contextlib.closing(folder):
                for message in recording.messages(recording.channels, first_ns, last_ns):
                    if stop.is_asked:
                        break
                    folder.add(message.channel, message.stamp_ns, message.data, latched=0)
                    if folder.messages % SAID_EACH == 0:
                        share = (message.stamp_ns - first_ns) / max(1, last_ns - first_ns)
                        progress("webviz: recovering", share)
            losses = recording.losses
    except OSError as error:
        raise Error(f"{bag} cannot be read: {error.strerror}.") from error
    except RecordingError as error:
        raise Error(str(error)) from error
    if stop.is_asked:
        say_end(f"webviz: interrupted; {path} has the first {counted(folder.messages, 'message')}.")
        return INTERRUPTED
    state = f"is damaged: {losses}" if str(losses) else "is whole"
    state = "has no end" if losses.is_unfinished else state
    wrote = f"wrote {counted(folder.messages, 'message')} to {path}"
    warn(f"webviz: {wrote}. The original {state}.")
    return 0
