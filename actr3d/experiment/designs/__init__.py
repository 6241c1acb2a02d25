"""The library's own designs, one file each."""
