"""The ground contact stabilizer: extra stance-leg torques that keep the stance foot loaded.

Seed 000_bd1305a0ae731442, section 3.1.
"""
