"""Raw servo measurements of the whole robot, filled by its buses tick by tick."""

from dataclasses import dataclass

import numpy as np

from hil.interface import Bools, Floats, Ints


@dataclass(slots=True)
class ServoStates:
    """Latest values of every servo in joint order, arrays of shape (n,). Stale ones stay."""

    position: Ints
    """[counts]"""
    velocity: Ints
    """[0.229 rev/min]"""
    current: Ints
    """[current units of the model]"""
    voltage: Floats
    """[V], NaN where never read."""
    temperature: Floats
    """[°C], NaN where never read."""
    error: Ints
    """`HardwareError` and `JointError` bits."""
    valid: Bools
    """Read in this tick."""
    time_ns: Ints
    """When position, velocity and current were sampled; -1 for never."""

    @classmethod
    def empty(cls, n: int) -> "ServoStates":
        """States of n servos of which nothing is known."""
        zeros = [np.zeros(n, dtype=np.int64) for _ in range(4)]
        return cls(
            position=zeros[0],
            velocity=zeros[1],
            current=zeros[2],
            voltage=np.full(n, np.nan),
            temperature=np.full(n, np.nan),
            error=zeros[3],
            valid=np.zeros(n, dtype=np.bool_),
            time_ns=np.full(n, -1, dtype=np.int64),
        )
