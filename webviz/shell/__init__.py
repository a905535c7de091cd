"""What people start: the command line, the Python API, pictures, visual tests."""
