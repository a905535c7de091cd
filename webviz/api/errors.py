"""The base classes of webviz's errors."""


class Error(Exception):
    """An error that users can fix; one sentence with the cause and a remedy."""


class UsageError(Error):
    """An error in the arguments themselves, whatever files and topics there are."""
