"""`python -m webviz` is `webviz`."""

import sys

from webviz.cli.main import main

sys.exit(main())
