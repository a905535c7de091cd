"""The command line, the Python API, pictures and visual tests."""
