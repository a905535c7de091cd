"""`python -m webviz` is `webviz`."""

import sys

from webviz.cli import main

sys.exit(main())
