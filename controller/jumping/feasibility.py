"""Whether a robot's actuators can do a jump: its curves against their limits, before it moves."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from controller.jumping.jump_curves import JumpCurves
from controller.jumping.path import JumpTarget
from controller.jumping.rehearsal import rehearse
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import Floats

HALVINGS = 6
"""Of the search for the largest jump that fits: to 2 % of what was asked for."""


@dataclass(frozen=True, slots=True)
class Demand:
    """What the hardest moment of the hardest joint needs, as shares of its limits."""

    joint: str
    torque: float
    """[N·m]"""
    available: float
    """Torque that the actuator has at that speed [N·m]."""
    speed: float
    """[rad/s]"""
    speed_limit: float
    """[rad/s]"""
    ratio: float
    """The larger of both shares; above 1 it does not fit."""

    def __str__(self) -> str:
        if abs(self.speed) / self.speed_limit >= min(self.ratio, 1.0):
            return f"{self.joint} needs {abs(self.speed):.1f} rad/s and has {self.speed_limit:.1f}"
        return (
            f"{self.joint} needs {abs(self.torque):.3g} N·m at {self.speed:.1f} rad/s and has "
            f"{self.available:.3g}"
        )


def available_torque(description: RobotDescription, velocity: Floats, torque: Floats) -> Floats:
    """Torque limits at these speeds [N·m], (K, n).

    A servo that drives its load loses torque with speed, τ(ω) = τ_stall·(1 − |ω|/ω₀), and holds
    τ_stall against a load that drives it; a torque robot has its limit at every speed.
    """
    stall = np.array([joint.torque_limit for joint in description.joints])
    if description.actuation == "torque":
        return np.broadcast_to(stall, velocity.shape)
    no_load = np.array([joint.velocity_limit for joint in description.joints])
    driving = np.where(torque * velocity > 0.0, np.abs(velocity) / no_load, 0.0)
    return np.asarray(stall * np.maximum(1.0 - driving, 1e-3))


def demand(description: RobotDescription, curves: JumpCurves) -> Demand:
    """The hardest moment of windup and push."""
    velocity, torque = curves.velocity, curves.torque
    limits = np.array([joint.velocity_limit for joint in description.joints])
    available = available_torque(description, velocity, torque)
    share = np.maximum(np.abs(torque) / available, np.abs(velocity) / limits)
    step, joint = np.unravel_index(int(np.argmax(share)), share.shape)
    return Demand(
        description.joint_names[joint],
        float(torque[step, joint]),
        float(available[step, joint]),
        float(velocity[step, joint]),
        float(limits[joint]),
        float(share[step, joint]),
    )


def require_feasible(description: RobotDescription, target: JumpTarget) -> JumpCurves:
    """The curves of a jump that fits. Raises InputError, with the largest one that does."""
    try:
        curves = rehearse(description, target)
        needs: Demand | InputError = demand(description, curves)
        if isinstance(needs, Demand) and needs.ratio <= 1.0:
            return curves
    except InputError as error:
        needs = error
    largest = largest_jump(description, target)
    hint = (
        "no jump of this kind fits"
        if largest is None
        else f"the largest that fits: {_say(largest)}"
    )
    raise InputError(f"{description.name} cannot jump so: {needs}; {hint}")


def largest_jump(description: RobotDescription, target: JumpTarget) -> JumpTarget | None:
    """The largest share of a jump that fits, found by halving; None if none does.

    First a shorter one of the same airtime is looked for, then distance and airtime shrink
    together, the airtime no further than a change of height needs.
    """
    x, y, _ = target.displacement
    if x or y:
        nearer = _largest(description, lambda share: _scaled(target, share, 1.0))
        if nearer is not None:
            return nearer
    return _largest(description, lambda share: _scaled(target, share, share))


def _largest(
    description: RobotDescription, scaled: Callable[[float], JumpTarget | None]
) -> JumpTarget | None:
    """The target of the largest share below 1 that fits."""
    fits, share, step = None, 0.0, 0.5
    for _ in range(HALVINGS):
        smaller = scaled(share + step)
        if smaller is not None and _fits(description, smaller):
            fits, share = smaller, share + step
        step /= 2.0
    return fits


def _fits(description: RobotDescription, target: JumpTarget) -> bool:
    try:
        return demand(description, rehearse(description, target)).ratio <= 1.0
    except InputError:
        return False


def _scaled(target: JumpTarget, distance: float, time: float) -> JumpTarget | None:
    """Shares of distance and airtime; None where it cannot rise to its height in that time."""
    x, y, z = target.displacement
    try:
        return replace(
            target, displacement=(distance * x, distance * y, z), airtime=time * target.airtime
        )
    except InputError:
        return None


def _say(target: JumpTarget) -> str:
    x, y, z = target.displacement
    return (
        f"--target {x:.3g} {y:.3g} {z:.3g} --airtime {target.airtime:.3g} "
        f"--push-depth {target.push_depth:.3g}"
    )
