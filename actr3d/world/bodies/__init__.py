"""The bodies that minds can live in, one a file."""
