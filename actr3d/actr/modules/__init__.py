"""ACT-R modules besides memory and the production systems, one per file."""
