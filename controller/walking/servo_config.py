"""The `walking` section of a servo robot's description."""

from pydantic import Field, PositiveFloat

from controller.walking.alteration import AlterationConfig
from controller.walking.command_ramp import CommandConfig
from controller.walking.gait import GaitConfig
from controller.walking.heading import HeadingConfig
from controller.walking.height_trim import HeightTrimConfig
from controller.walking.landing_trim import LandingTrimConfig
from controller.walking.learned_load import LearnedLoadConfig
from controller.walking.place_trim import PlaceTrimConfig
from controller.walking.sole_trim import SoleTrimConfig
from controller.walking.swing_governor import GovernorConfig
from hil.description import RobotDescription
from hil.validation import Config, validate


class PlacementConfig(Config):
    """Where the swing foot lands."""

    step_width: PositiveFloat
    """Lateral distance between the ankles in steady walking [m]."""
    gain_x: PositiveFloat
    """Factor on the predicted sagittal capture point."""
    gain_y: PositiveFloat
    """Factor on the predicted lateral capture point."""
    max_length: PositiveFloat
    """Largest sagittal distance from the stance ankle [m]."""
    min_width: PositiveFloat
    """Smallest lateral distance from the stance ankle [m]: the soles must not touch."""
    max_width: PositiveFloat
    """Largest lateral distance from the stance ankle [m]."""
    touch_down_delay: float
    """Added to the remaining time of a step: contact is felt late [s]."""
    freeze_phase: PositiveFloat
    """The landing point moves no more after this phase."""


class SwingConfig(Config):
    """How the swing foot travels."""

    height: PositiveFloat
    """Lift of the foot at mid-swing [m]."""
    flatness: float = Field(ge=0, le=0.25)
    """Third harmonic of the lift speed: trades peak knee speed against knee acceleration."""
    landing_phase: PositiveFloat
    """The foot is above its landing point from this phase on."""
    ramp: float = Field(gt=0, le=0.5)
    """Share of its way's time in which the foot speeds up, and in which it slows down."""
    search_speed: PositiveFloat
    """Speed of the foot's target below the ground after phase 1 [m/s]."""


class BalanceConfig(Config):
    """Velocity tuning by the centre of pressure of the stance foot."""

    gain_x: float = Field(ge=0)
    """ZMP per deviation of the capture point, sagittal."""
    gain_y: float = Field(ge=0)
    """ZMP per deviation of the capture point, lateral."""
    limit_x: float = Field(gt=0, le=1)
    """ZMP limit as a fraction of the ankle's distance to the nearer sole end."""
    limit_y: float = Field(gt=0, le=1)
    """ZMP limit as a fraction of the sole's half width."""
    ahead: float
    """Centre of pressure of a balanced stance ahead of the ankle [m]."""
    feedback: float = Field(ge=0)
    """Factor on the error of the measured centre of pressure, added to the wanted one."""
    settle_time: float = Field(ge=0)
    """The measured centre of pressure counts from this time in a step on [s]."""
    load_transfer_time: PositiveFloat
    """The feed-forward load moves to a new stance foot in this time [s]."""
    torque_gain: float = Field(ge=0)
    """Factor on the feed-forward torque of weight and ground reaction."""
    inertia_gain: float = Field(ge=0)
    """Factor on the swing leg's inertia torque M·q̈*."""


class TimingConfig(Config):
    """Adaptation of the step time to the lateral motion."""

    gain: float = Field(ge=0)
    """Factor on the time correction; 0 turns it off."""
    dead_band: float = Field(ge=0)
    """Corrections below this are ignored [s]."""
    min_time: PositiveFloat
    """Shortest step [s]."""
    max_stretch: PositiveFloat
    """Longest step, as a multiple of the nominal period."""
    outside: PositiveFloat
    """A capture point that far beyond the outside of the ankle asks for landing now [m]."""
    swing_speed: PositiveFloat
    """No step is shortened below the time that its foot, at this mean speed, still needs [m/s]."""


class WeightShiftConfig(Config):
    """How walking begins."""

    time: PositiveFloat
    """Duration of the shift [s]."""
    distance: PositiveFloat
    """Lateral motion of the pelvis towards the first stance foot [m]."""


class ServoWalkingConfig(Config):
    """Everything the servo walker needs beyond the robot's body."""

    gait: GaitConfig
    hip_height: PositiveFloat
    """Hip centres above the sole [m]."""
    latency: float = Field(ge=0)
    """From a tick to the moment its goals act [s]; targets are meant for half a tick after it."""
    command: CommandConfig
    heading: HeadingConfig
    yaw_limit: PositiveFloat
    """Largest angle between torso and a foot [rad]."""
    placement: PlacementConfig
    swing: SwingConfig
    governor: GovernorConfig
    learned_load: LearnedLoadConfig
    balance: BalanceConfig
    timing: TimingConfig
    place_trim: PlaceTrimConfig
    landing_trim: LandingTrimConfig
    sole_trim: SoleTrimConfig
    height_trim: HeightTrimConfig
    alteration: AlterationConfig
    """Sagittal."""
    lateral_alteration: AlterationConfig
    """Lateral, over whole strides."""
    weight_shift: WeightShiftConfig


def servo_walking_config(description: RobotDescription) -> ServoWalkingConfig:
    """The walking section of a description. Raises DescriptionError."""
    return validate(ServoWalkingConfig, description.walking, description.file, "walking")
