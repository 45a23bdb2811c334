"""Procedures on registers: search, set up, inspect, move one servo, switch torque off."""
