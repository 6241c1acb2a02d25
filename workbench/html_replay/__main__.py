"""`python -m workbench.html_replay RECORDING FILE` writes the replay of a recording; the server runs it in a process of its own."""

from __future__ import annotations

import sys
from pathlib import Path

from actr3d.errors import Actr3dError
from workbench.html_replay.make import write_replay

if __name__ == "__main__":
    try:
        write_replay(Path(sys.argv[1]), Path(sys.argv[2]))
    except (Actr3dError, OSError) as error:
        sys.exit(str(error))
