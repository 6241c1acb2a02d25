"""What existing Python ACT-R models need besides the core: the old import names, grid worlds, log files."""
