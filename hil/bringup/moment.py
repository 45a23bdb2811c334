"""What joints, cells and IMU say for a moment: the raw material of calibration."""

from dataclasses import dataclass, field

from hil.interface import Floats


@dataclass(frozen=True, slots=True)
class Cells:
    """Four cells of one foot over a moment, in counts; corners in interface order."""

    mean: Floats
    """Shape (4,)."""
    deviation: Floats
    """Standard deviation, shape (4,)."""
    valid: tuple[bool, ...]
    """Whether the board said so in every frame."""


@dataclass(frozen=True, slots=True)
class Inertia:
    """An IMU over a moment, in its own axes."""

    force: Floats
    """Mean specific force [m/s²], shape (3,)."""
    gyro: Floats
    """Mean angular velocity [rad/s], shape (3,)."""
    orientation: Floats
    """Its own, sensor to world (w, x, y, z), of the last frame."""
    unrest: float
    """Largest standard deviation of an axis of the gyro [rad/s]."""


@dataclass(frozen=True, slots=True)
class Moment:
    """Everything that was heard."""

    angles: dict[str, float]
    """Mean of direction·(counts − 2048)/COUNTS_PER_RADIAN [rad], by joint that answered."""
    unrest: dict[str, float]
    """Difference of largest and smallest [rad], by joint."""
    feet: dict[str, Cells] = field(default_factory=dict)
    """By side."""
    imu: Inertia | None = None
