"""The 28-DOF human of the seeds: description, model and derivations."""
