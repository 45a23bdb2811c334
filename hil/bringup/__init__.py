"""Bring-up: what a builder does before the first walk, from one servo to a checked robot."""
