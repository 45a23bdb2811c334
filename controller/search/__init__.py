"""Costs and search spaces of the offline optimisations: what is minimised, over which variables."""
