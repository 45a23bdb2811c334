"""Steering a run while it goes on: from keys, a gamepad, the live view or the run's socket."""
