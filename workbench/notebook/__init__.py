"""Shows simulations and recordings in notebooks: the workbench's own page, in a frame, from a server that belongs to the notebook."""
