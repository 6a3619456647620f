"""Lets ``python -m cobot_lfd`` be the command line."""

import sys

from cobot_lfd.app.cli import main

if __name__ == "__main__":
    sys.exit(main())
