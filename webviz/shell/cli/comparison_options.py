"""The options for a second run beside a bag."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Group, Parameter

from webviz.data.words import number_in

if TYPE_CHECKING:
    from webviz.sources.bag.comparison import Align
    from webviz.sources.player import Player

COMPARISON = Parameter(group=Group("A second bag beside it", sort_key=3))


def align_of(text: str) -> "Align | float":
    """Return the alignment of a second bag that an option names.

    Raises:
        ValueError: it is not one.
    """
    if text in ("start", "stamp", "path"):
        return text
    seconds = number_in(text)
    if seconds is None:
        raise ValueError(f"{text} is not start, stamp, path or seconds.")
    return seconds


def _check_align(type_: object, text: str) -> None:
    """Raise ValueError for what is not an alignment."""
    align_of(text)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ComparisonOptions:
    """The second bag, and when it begins."""

    ghost: Annotated[Path | None, COMPARISON, Parameter(metavar="FILE")] = None
    """Show a second bag beside it, tinted, with topics in /ghost and transforms of its own."""
    ghost_align: Annotated[
        str, COMPARISON, Parameter(metavar="ALIGN", validator=_check_align, show_default=False)
    ] = "start"
    """Times of the second bag: start (default), stamp, path (where the robots are closest), or
    seconds after the start."""
    ghost_difference: Annotated[str, COMPARISON, Parameter(metavar="PATH", show_default=False)] = ""
    """Also plot the difference of this number, such as /odom.twist.twist.linear.x."""

    def check_comparison(self, has_bag: bool) -> None:
        """Raise ValueError for an invalid combination of arguments."""
        if self.ghost is None and (self.ghost_align != "start" or self.ghost_difference):
            raise ValueError("--ghost-align and --ghost-difference need --ghost.")
        if self.ghost is not None and not has_bag:
            raise ValueError("--ghost needs --bag.")

    def beside(self, bags: Path | Sequence[Path], ros_args: Sequence[str] = ()) -> "Player":
        """Return bags with the second one beside them, if one is given.

        Raises:
            Error: a bag cannot be read.
        """
        from webviz.shell.bag_player import bag_player
        from webviz.sources.bag.comparison import ComparisonRun

        if self.ghost is None:
            return bag_player(bags, ros_args=ros_args)
        run = ComparisonRun(self.ghost, align_of(self.ghost_align), self.ghost_difference)
        return bag_player(bags, ros_args=ros_args, comparison=run)
