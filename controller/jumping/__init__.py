"""Jumping to a target position: one module a stage, each usable alone.

Seed 004_2880d7939e94ed85, chapter 3: path estimation, windup, thrust; flight and landing are ours.
"""
