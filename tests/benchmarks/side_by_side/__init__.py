"""Viewers next to each other on the same messages: what they show, how late, and at what cost.

`python -m side_by_side --help`, with tests/benchmarks and tests/support on PYTHONPATH as
`make bench` has them. README.md beside this package tells what is measured and how it came out.
"""
