"""Experiments with models: measures, trials and comparisons with human data; one package for each field."""
