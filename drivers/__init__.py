"""Drivers of real hardware: Dynamixel bus, foot load-cell boards, IMU board. No simulation."""
