"""What a torque robot's description says under `walking`."""

from typing import Literal

from pydantic import Field, NonNegativeFloat, PositiveFloat, model_validator

from controller.walking.alteration import AlterationConfig
from controller.walking.combiner import PATH, KnotList, Law, StyleConfig
from controller.walking.command_ramp import CommandConfig
from controller.walking.foot_placement import FootPlacementConfig
from controller.walking.gait import GaitConfig
from controller.walking.hand_poses import HandPosesConfig
from controller.walking.heading import HeadingConfig
from controller.walking.key_poses import Knots
from controller.walking.leg_crossing import LegCrossingConfig
from controller.walking.recovery import RecoveryConfig
from controller.walking.stabilizer.config import StabilizerConfig
from controller.walking.take_over import TakeOverConfig
from controller.walking.velocity_offset import VelocityOffsetConfig
from hil.description import RobotDescription
from hil.joint_gains import GainSet, set_for
from hil.validation import Config, validate

Vector3 = tuple[float, float, float]


class TrackingConfig(Config):
    """How one joint's pose is tracked."""

    frame: Literal["parent", "heading"]
    """Frame in which the target orientation and the angular velocity are expressed."""
    scale: Vector3
    """Factors on the gains about x, y, z of that frame (roll, pitch, yaw)."""


class KeyPoses(Config):
    """Target curves over the phase of a left-stance step; yaw and roll mirror on the right."""

    root_pitch: KnotList
    back_yaw: KnotList
    back_pitch: KnotList
    back_roll: KnotList
    stance_knee: KnotList
    stance_foot: KnotList
    """Pitch of the stance foot in its heading frame, positive toe down [rad]."""
    swing_foot: KnotList
    """Pitch of the swing foot in the heading frame [rad]."""
    swing_drop: KnotList
    """Height of the swing hip above the swing ankle [m]."""

    def curves(self) -> list[Knots]:
        """All curves in the order of the fields."""
        return [getattr(self, name) for name in type(self).model_fields]


class RootBalanceConfig(Config):
    """Pelvis orientation by the hips."""

    scale: Vector3
    """Factors on the root gains about x, y, z of the heading frame."""
    hip_damping: NonNegativeFloat
    """c of the stance hip [N·m·s²/rad²]."""
    hip_damping_limit: PositiveFloat
    """Largest angular velocity that counts in the damping's direction [rad/s]."""


class SwingLegConfig(Config):
    """Inverse kinematics of the swing leg."""

    reach: float = Field(gt=0, lt=1)
    """Longest hip-ankle distance, as a fraction of the straight leg."""
    rate_limit: PositiveFloat
    """Largest target joint velocity [rad/s]."""


class VirtualForceConfig(Config):
    """Speed control by a virtual force on the body."""

    gain: tuple[float, float]
    """Sagittal and coronal [1/s]: acceleration per speed error."""
    limit: PositiveFloat
    """Largest force, as a fraction of body weight."""


class LearnedVelocityConfig(Config):
    """The velocity curve that is learned over steps."""

    knots: int = Field(ge=4)
    threshold: PositiveFloat
    """Mean deviation above which a step is not learned from [m/s]."""
    rate: float = Field(gt=0, le=1)
    """Part of the clipped deviation that is adopted."""
    normalise: Literal["median", "mean"]
    """What of the observed speed is made equal to that of the curve; the seed: the median."""
    sagittal: Literal["shifted", "scaled"] = "shifted"
    """How the sagittal speed is made so; the coronal one is always shifted."""
    least_scaled: PositiveFloat = 0.1
    """Slower walks are shifted: the ratio of two small speeds says nothing [m/s]."""


class AnkleLimitConfig(Config):
    """Stance-ankle torque that keeps the centre of pressure inside the sole."""

    fraction: float = Field(gt=0, le=1)
    """κ: part of the sole that the centre of pressure may use."""


class TorqueWalkingConfig(Config):
    """The whole walking section of a torque robot."""

    gait: GaitConfig
    heading: HeadingConfig
    command: CommandConfig
    placement: FootPlacementConfig
    take_over: TakeOverConfig
    leg_crossing: LegCrossingConfig
    alteration: AlterationConfig
    coronal_alteration: AlterationConfig
    """The same for the coronal axis, by the mean speed of two steps."""
    swing_leg: SwingLegConfig
    virtual_force: VirtualForceConfig
    learned_velocity: LearnedVelocityConfig
    velocity_offset: VelocityOffsetConfig
    recovery: RecoveryConfig
    root_balance: RootBalanceConfig
    hip_gravity: Literal["implicit", "always", "never"]
    """With which PD the stance hip carries the weights above it (`hip_gravity`)."""
    buoyancy_compensation: bool = True
    """Take what a liquid carries out of gravity compensation."""
    drag_compensation: bool = True
    """Carry the swing leg's drag: sideways, and in thick liquids (`drag_compensation`)."""
    ankle_limit: AnkleLimitConfig
    ankle_guards: bool = False
    """Guard the ankles by the rules of the first author's stored code (`ankle_guards`)."""
    stabilizer: StabilizerConfig = StabilizerConfig()
    tracking: dict[str, TrackingConfig]
    """By joint: the name without side and axis, `back`, `hip`, `ankle`."""
    side_scales: dict[str, Vector3]
    """Factors of single joints that replace `tracking.*.scale`, by name with side."""
    gains: dict[int, GainSet]
    """Stiffness [N·m/rad] and damping [N·m·s/rad] by rate [Hz], then by joint and `root`."""
    gain_rate: int | None = None
    """Gain set to use whatever the rate; none picks it by the rate."""
    explicit_gain_rates: tuple[int, ...] = Field(min_length=1)
    """Sets from which explicit PD picks by its control rate."""
    implicit_gain_rate: int
    """Gain set of implicit PD, whatever the rate, unless `gain_rate` is set."""
    key_poses: KeyPoses
    """Of the standard controller."""
    styles: tuple[StyleConfig, ...] = ()
    """Simple controllers that differ from it (`combiner`); none: the standard one alone."""
    references: tuple[StyleConfig, ...] = ()
    """Simple controllers that an offline search found."""
    use_references: bool = False
    """Take those too; at their speeds and levels they replace the others."""
    style_law: Law = "square"
    """How two neighbouring styles are mixed."""
    hands: HandPosesConfig | None = None
    """Where the hands are kept; none: the arms hold the start pose."""
    fallen_height: PositiveFloat
    """The robot has fallen, and all torques are zero, with the root below this height [m]."""

    @property
    def chosen_styles(self) -> tuple[StyleConfig, ...]:
        """The simple controllers that the combiner mixes."""
        if not self.use_references:
            return self.styles
        found = {style.cell for style in self.references}
        kept = [style for style in self.styles if style.cell not in found]
        return (*kept, *self.references)

    @model_validator(mode="after")
    def _complete(self) -> "TorqueWalkingConfig":
        wanted = {"root", *self.tracking}
        for rate, gains in self.gains.items():
            if set(gains) != wanted:
                odd = ", ".join(sorted(set(gains) ^ wanted))
                raise ValueError(f"gains.{rate}: joints missing or unknown: {odd}")
        known = (*KeyPoses.model_fields, *PATH)
        for style in (*self.styles, *self.references):
            strangers = sorted(set(style.poses) - set(known))
            if strangers:
                raise ValueError(
                    f"styles: no such trajectory: {', '.join(strangers)}; valid: {', '.join(known)}"
                )
        for name, styles in (("styles", self.styles), ("references", self.references)):
            places = [style.cell for style in styles]
            if len(set(places)) < len(places):
                raise ValueError(f"{name}: two for the same speed and water level (and resistance)")
        chosen = (self.gain_rate, self.implicit_gain_rate, *self.explicit_gain_rates)
        for rate_key in chosen:
            if rate_key is not None and rate_key not in self.gains:
                valid = ", ".join(str(rate) for rate in sorted(self.gains))
                raise ValueError(f"gain set {rate_key} is not in gains; valid: {valid}")
        return self

    def gains_at(self, rate_hz: int, implicit: bool) -> GainSet:
        """The gain set of a control rate [Hz]; of explicit PD by `joint_gains.set_for`."""
        if self.gain_rate is not None:
            return self.gains[self.gain_rate]
        if implicit:
            return self.gains[self.implicit_gain_rate]
        return self.gains[set_for(self.explicit_gain_rates, rate_hz)]


def torque_walking_config(description: RobotDescription) -> TorqueWalkingConfig:
    """The walking section of a description. Raises DescriptionError."""
    return validate(TorqueWalkingConfig, description.walking, description.file, "walking")
