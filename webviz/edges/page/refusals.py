"""What a page is answered whose message its role does not allow."""

from __future__ import annotations

from webviz.edges.page.invitation_messages import Dismiss, Invitation, Invite
from webviz.edges.page.messages import (
    Do,
    Done,
    Drive,
    FromPage,
    Gripped,
    GripRefused,
    HelmReport,
    Result,
    StrokeDone,
    ToPage,
    Use,
)


def answer(message: FromPage, reason: str) -> ToPage | None:
    """The answer to a refused message, None if it is one without answers.

    Args:
        message: of the page.
        reason: a sentence.
    """
    match message:
        case Do() | Use() | Dismiss():
            return Done(message.number, "error", reason, "")
        case StrokeDone():
            return Result(message.number, "error", reason)
        case Gripped():
            return GripRefused(f"{message.display}/{message.handle}", message.kind, reason)
        case Invite():
            return Invitation(message.number, reason, "", "")
        case Drive():
            return HelmReport(message.tool, 0, None, reason)
        case _:
            return None
