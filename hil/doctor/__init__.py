"""What this computer lacks to run a robot, each with its remedy."""
