"""Sensor boards on serial ports: foot load cells and IMU."""
