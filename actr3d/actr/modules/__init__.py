"""ACT-R modules besides memory and the production systems, one a file."""
