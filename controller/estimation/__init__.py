"""State estimation from encoders, IMU and foot-corner load cells."""
