"""Plots of one recorded run: each module draws one question that a walk is asked."""
