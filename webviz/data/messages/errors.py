"""Errors of messages; each text is one sentence."""


class MessageError(ValueError):
    """Base of every error raised by `webviz.data.messages`."""


class DecodeError(MessageError):
    """The bytes are not a message of the given type."""


class EncodeError(MessageError):
    """A value does not fit its field of a message."""


class UnknownTypeError(MessageError):
    """No definition of this message type is known."""


class DefinitionError(MessageError):
    """A message definition is invalid, or contradicts one that is in use."""
