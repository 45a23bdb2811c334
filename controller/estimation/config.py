"""Settings of the estimators: times and fractions that do not depend on a robot's size."""

from pydantic import Field, PositiveFloat

from hil.validation import Config


class ContactConfig(Config):
    """When a foot counts as being on the ground."""

    filter_time: float = Field(default=0.010, ge=0)
    """First-order filter of the corner forces [s]."""
    on: PositiveFloat = 0.30
    """Load that makes a contact, as a fraction of body weight."""
    off: PositiveFloat = 0.10
    """Load below which it ends, as a fraction of body weight."""


class TrimConfig(Config):
    """How the IMU's tilt error is learnt from flat soles."""

    time: PositiveFloat = 5.0
    """Time constant once the first mean is taken, counted in ticks with a flat foot [s]."""
    corner_load: PositiveFloat = 0.0145
    """Load that makes a corner count, as a fraction of body weight."""
    foot_load: PositiveFloat = 0.3
    """Load that makes a foot count, as a fraction of body weight."""
    bound: PositiveFloat = 0.05
    """Largest error corrected about each axis [rad]."""


class EstimatorConfig(Config):
    """How frames become an estimate."""

    contact: ContactConfig = ContactConfig()
    trim: TrimConfig = TrimConfig()
    velocity_time: PositiveFloat = 0.008
    """Filter of differentiated encoder positions, and of the gyro so that both lag alike [s]."""
    coast_time: PositiveFloat = 0.060
    """A joint that went silent moves on with its last velocity for so long, then holds [s]."""
    attitude_time: PositiveFloat = 0.020
    """Time constant with which the gyro's integral is pulled to the IMU's orientation [s]."""
    imu_timeout: PositiveFloat = 0.030
    """An IMU silent for longer is replaced by the attitude of the flat stance foot [s]."""
    trust_time: float = Field(default=0.015, ge=0)
    """A foot counts in the odometry when it has been on the ground for so long [s]."""
