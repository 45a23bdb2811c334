"""Simple hydrodynamics of a body that is partly under water."""
