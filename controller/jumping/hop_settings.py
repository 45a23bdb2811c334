"""How a robot of position servos hops: one gesture of its legs, and how it draws them up."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class HopSettings:
    """Lengths in leg lengths, times in √(L/g), angles in radians, toes down positive.

    Found by a search on the minibiped (docs/jumping-results.md) for time in the air, clearance of
    the feet and standing after it: how fast the body leaves, against how fast rotors, heavier at
    the joint than all they move, are turned round afterwards.
    """

    push_depth: float = 0.158
    """Rise of the centre of mass in the push, where nobody says."""
    take_off_knee: float = 1.83
    """Bend at take-off. A knee of bend θ between links ℓ lifts the body, and draws the foot up
    later, on a lever as ℓ·sin(θ/2): a deep one needs less speed, and lifts the foot faster."""
    softness: float = 0.21
    """Time constant with which the knees come to their speed, as a share of the push."""
    heel_begin: float = 0.57
    """Share of the push after which the heels rise: two more joints lift, and the toes leave the
    ground as soon as the ankles turn back."""
    heel_rise: float = 0.12
    """Pitch of the feet at take-off."""
    heel_softness: float = 0.8
    """Time constant of the heels, as a share of their time."""
    trunk_back: float = 0.67
    """How far the hips stretch as the heels rise, as a share of the feet's pitch."""
    hip_begin: float = -0.006
    """Hips ahead of the ankles in the crouch."""
    hip_end: float = 0.026
    """And at take-off: the force of the toes must pass the centre of mass."""
    draw_up_ahead: float = 0.06
    """The knees get their goal of the air so long before take-off: teeth cross their gap first."""
    drawn_up_knee: float = 2.25
    """Bend that the knees are given as a goal in the air."""
    drawn_up_trunk: float = 0.27
    """Pitch of the trunk that the hips are given as a goal in the air."""
    drawn_up_foot: float = -0.26
    """Pitch of the feet that the ankles are given."""
    drop: float = 0.026
    """How much lower over the soles the centre of mass is at touch-down than at take-off."""
    windup_time: float = 10.0
    """From the start pose to the crouch."""
    pause: float = 1.0
    """In the crouch."""
    landing_hip: float = -0.07
    """Hips ahead of the ankles where a landing comes to rest, knees as they were drawn up."""
    landing_time: float = 0.79
    """From touch-down until the joints are told so."""
    return_time: float = 6.5
    """From there back to the start pose."""
