"""How a robot's simulated twin behaves: sections `supply`, `plant` and `noise` of a description.

Units are SI; keys carry a unit suffix where SI would be unhandy (`_us`).
"""

from typing import Annotated, Literal, Self

from pydantic import Field, PositiveFloat, PositiveInt, model_validator

from hil.validation import Config

DeadCell = Literal[
    "left_foot:front_left",
    "left_foot:front_right",
    "left_foot:rear_left",
    "left_foot:rear_right",
    "right_foot:front_left",
    "right_foot:front_right",
    "right_foot:rear_left",
    "right_foot:rear_right",
]
"""One load cell, by its foot and its corner."""

NotNegative = Annotated[float, Field(ge=0)]
ByJoint = float | dict[str, float]
"""One value for every joint, or values of joints by name; the others keep theirs."""
NotNegativeByJoint = NotNegative | dict[str, NotNegative]
PositiveByJoint = PositiveFloat | dict[str, PositiveFloat]


class Supply(Config):
    """The servo supply."""

    voltage: PositiveFloat
    """Open-circuit voltage [V]."""
    resistance: float | None = Field(default=None, ge=0)
    """Pack and wiring, shared by all servos [Ω]; none is drawn, or 0.1 without draws."""
    current_limit: PositiveFloat | None = None
    """Current that the pack or regulator gives at most [A]; above it the voltage folds back."""


class Draws(Config):
    """Ranges from which a seed draws what a simulated robot hides; none leaves it nominal.

    One value a joint where a joint has its own. A key of `Plant` of the same name (for the supply
    `supply.resistance`) fixes the quantity instead.
    """

    armature: tuple[float, float] | None = None
    """[kg·m²]"""
    joint_friction: tuple[float, float] | None = None
    """[N·m]"""
    torque_constant_scale: tuple[float, float] | None = None
    joint_zero: tuple[float, float] | None = None
    """[rad]"""
    backlash: tuple[float, float] | None = None
    """Full gap [rad]."""
    pitch_bias: tuple[float, float] | None = None
    """[rad]"""
    supply_resistance: tuple[float, float] | None = None
    """[Ω]"""
    floor_height: tuple[float, float] | None = None
    """Lowest and highest point of an uneven floor [m]."""

    @model_validator(mode="after")
    def _rising(self) -> Self:
        for key in type(self).model_fields:
            limits = getattr(self, key)
            if limits is not None and limits[0] > limits[1]:
                raise ValueError(f"{key}: a range must not fall, got {list(limits)}")
        return self


class Plant(Config):
    """How the simulated twin differs from the nominal model.

    Quantities that `draws` covers too: a number fixes them for every joint, `{left_knee: 0.2}` for
    the joints that it names; the seed draws the rest, or it stays nominal where nothing is drawn.
    """

    floor_friction: PositiveFloat
    mass_scale: PositiveFloat = 1.0
    """Factor on the mass and inertia of the root body."""
    substeps: PositiveInt | None = None
    """Physics steps a tick; none takes the fewest that reach the clock's substep frequency."""
    pad_stiffness: PositiveFloat = 1.0
    """Factor on the stiffness of soles and floor."""
    dead_cells: tuple[DeadCell, ...] = ()
    """Load cells that measure nothing."""
    latency_ticks: int = Field(default=0, ge=0)
    """Whole ticks by which goals act later than wires and computer explain."""
    water_cell: PositiveFloat | None = None
    """Size of the surface elements that feel a liquid's drag [m]; none: 1/47 of the leg, the 2 cm
    of a human one."""
    ball: bool = False
    """Have a ball that can be thrown at the robot."""
    hoist: bool = False
    """Hang the robot up by its root body, its feet off the floor: nothing lets it down."""
    gravity: PositiveFloat | None = None
    """[m/s²]; none: the model's own."""
    platform: tuple[float, float, float, float, float] | None = None
    """A box on the floor: from x, to x, from y, to y, height [m]; a robot that starts over it
    stands on it."""
    viscous_friction: float = Field(default=0.0, ge=0)
    """Of every servo's gear train [N·m·s/rad]."""
    stribeck_friction: float = Field(default=0.0, ge=0)
    """Dry friction that fades as the joint moves [N·m]."""
    load_friction: float = Field(default=0.0, ge=0, lt=0.5)
    """Friction per torque on the gears, which fades too."""
    draws: Draws | None = None
    """What a seed draws; none is the nominal robot."""
    armature: NotNegativeByJoint | None = None
    """Reflected rotor inertia of every servo [kg·m²]; nominal: the MJCF's."""
    joint_friction: NotNegativeByJoint | None = None
    """Dry friction of every servo [N·m]; nominal: the MJCF's."""
    torque_constant_scale: PositiveByJoint | None = None
    """True torque and back-EMF constant over the data sheet's; nominal: 1."""
    joint_zero: ByJoint | None = None
    """Angle that the encoders show when the joint is at zero [rad]; nominal: 0."""
    backlash: NotNegativeByJoint | None = None
    """Full gap between gear train and horn [rad]; nominal: 0."""
    pitch_bias: float | None = None
    """Pitch of the IMU against the root body [rad]; nominal: 0."""
    floor_height: float | None = Field(default=None, ge=0)
    """Deviation of an uneven floor, up and down [m]; nominal: 0."""


class Noise(Config):
    """Standard deviations of what a seed draws. Zero is an ideal sensor."""

    attitude: float = Field(ge=0)
    """White noise of the IMU orientation [rad]."""
    attitude_bias: float = Field(ge=0)
    """Constant roll and pitch error of a run [rad]."""
    gyro: float = Field(ge=0)
    """White noise [rad/s]."""
    gyro_bias: float = Field(ge=0)
    """Constant error of a run [rad/s]."""
    accelerometer: float = Field(ge=0)
    """White noise [m/s²]."""
    corner_force: float = Field(ge=0)
    """White noise of one load cell [N]."""
    corner_zero: float = Field(ge=0)
    """Constant zero error of one load cell, after calibration [N]."""
    imu_delay_us: int = Field(ge=0)
    """Age of an IMU sample when its frame is sent."""
    board_jitter_us: int = Field(ge=0)
    """Random extra delay of a board frame, uniform from 0 to this."""
    usb_jitter_us: int = Field(ge=0)
    """Random extra delay of a USB transfer, uniform from 0 to this."""
