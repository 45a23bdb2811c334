"""The virtual robot: emulated servos and boards behind serial ports, moved by physics."""
