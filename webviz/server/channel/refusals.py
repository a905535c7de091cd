"""Refusals of messages that the role of a page does not allow, or that are not text."""

from __future__ import annotations

import re

import msgspec

from webviz.server.channel.messages import (
    CommandRequest,
    CommandResult,
    Drive,
    DrivingReport,
    FromPage,
    ToPage,
)

HALF = "Failed: the text contains half of a letter, such as of an emoji. Remove it."
_ESCAPE = re.compile(r"(\\\\)|\\u[dD][89a-fA-F][0-9a-fA-F]{2}")
"""A backslash, or half of a surrogate pair, in JSON."""


def answer(message: FromPage, reason: str) -> ToPage | None:
    """Return the answer to a refused message, None if it is one without answers.

    Args:
        message: of the page.
        reason: a sentence.
    """
    match message:
        case CommandRequest():
            return CommandResult(message.number, message.command, "error", reason, {})
        case Drive():
            return DrivingReport(message.tool, 0, None, reason)
        case _:
            return None


def answer_to_halves(decoder: msgspec.json.Decoder[FromPage], text: str) -> ToPage | None:
    """Return the answer to a message with lone surrogates, which texts of JavaScript may have.

    Args:
        decoder: of messages, which has refused this one.
        text: of the message.
    """
    try:
        message = decoder.decode(_ESCAPE.sub(lambda match: match[1] or "?", text))
    except (msgspec.MsgspecError, RecursionError):
        return None
    return answer(message, HALF)
