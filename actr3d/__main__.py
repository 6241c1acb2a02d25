"""`python -m actr3d`: the command `actr3d`."""

import sys

from actr3d.cli import main

if __name__ == "__main__":
    sys.exit(main())
