"""What people can put right."""


class Error(Exception):
    """Something asked of webviz cannot be done; one sentence says why and what to do next."""
