"""The worker process, in which one run of one model lives: whatever the model does, the server keeps running."""
