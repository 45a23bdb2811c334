"""Simulated bodies: the MuJoCo plant, servo physics, and the virtual robot behind serial ports."""
