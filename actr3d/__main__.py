"""The command `actr3d`, also as `python -m actr3d`."""

import os
import sys

RUNNING = ("run", "replay", "experiment", "fit")
"""The commands that run a model, or read a design, in their own process."""


def main() -> int:
    """Runs the command line; returns the exit code."""
    if sys.argv[1:2] and sys.argv[1] in RUNNING:
        _order_sets()
    try:
        from actr3d.cli import main as run  # what is loaded before a restart is loaded twice
    except KeyboardInterrupt:  # loading takes up to a second
        sys.stderr.write("stopped\n")
        return 130
    return run()


def _order_sets() -> None:
    """Restarts the command if the order of sets of texts would differ between two runs with one seed.

    Models run with PYTHONHASHSEED=0, whatever its value is. A Python that ignores the environment (`-E`, `-I`) cannot be
    restarted in this way.
    """
    if sys.flags.hash_randomization and not sys.flags.ignore_environment:
        os.environ["PYTHONHASHSEED"] = "0"
        os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
