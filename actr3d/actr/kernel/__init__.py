"""What every model is made of: a clock, a tree, methods that can be waited for, buffers, and a trace of it all."""
