"""What can go wrong with a message, each as one sentence for the person watching."""


class MessageError(ValueError):
    """Base of every error raised by `webviz.data.messages`."""


class DecodeError(MessageError):
    """The bytes are not a message of the type they are said to be."""


class EncodeError(MessageError):
    """A value does not fit the field of a message that it is meant for."""


class UnknownTypeError(MessageError):
    """No definition of this message type is known."""


class DefinitionError(MessageError):
    """A message definition cannot be read, or contradicts one that is in use."""
