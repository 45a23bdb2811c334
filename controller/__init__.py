"""State estimation and walking control of a biped: functions of what was measured, no I/O."""
