"""After a run: what its recording says of the robot, and where two recordings differ."""
