"""Robots that ship: one folder a robot, with its description, model and derivation."""
