"""minibiped: a 0.5 m biped of twelve servos."""
