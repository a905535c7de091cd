"""The base class of webviz's errors."""


class Error(Exception):
    """An error that users can fix; one sentence with the cause and a remedy."""
