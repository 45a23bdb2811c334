"""StrideBridge: interface, robot descriptions, loop, recorder, reports and command line."""

__version__ = "0.1.0"
