"""Explanations: why a production matches or not, why a chunk is retrieved, what a model is like now or was like before."""
