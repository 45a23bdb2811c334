"""Friction of gear trains that fades with speed and grows with the load on the teeth."""

import math

from hil.interface import Floats, Ints
from hil.twin import Plant

STRIBECK_VELOCITY = 1.52
"""Speed at which the fading part has come down to 1/e [rad/s]."""
CURVATURE = 1.334
"""Exponent of the fading. Both as identified on an MX-64, the nearest relative of the XM430 with
public figures (Rhoban bam, params/mx64/m4.json: dtheta_stribeck 1.521, alpha 1.334; that servo
has friction_base 0.062, friction_stribeck 0.024, load_friction_stribeck 0.234, viscous 0.015)."""


class GearFriction:
    """Dry friction of each gear train, anew in every substep.

    Model M4 of Duclusaud, Rouxel, Passault, "Extended Friction Models for the Physics Simulation
    of Servo Actuators" (Rhoban bam, bam/model.py), with no load term at speed, as identified:

        F(ω, τ) = F_c + (F_s + K_l·|τ_e − τ_m|)·exp(−|ω/ω_s|^α)

    The torque on the gears is taken as in balance, |τ_e − τ_m| = 2·|τ_m|: the external torque is
    not known before the step is made. Viscous friction is the joint's damping in MuJoCo.
    """

    def __init__(
        self, plant: Plant, torque_constant: Floats, limits: Floats, dofs: slice | Ints
    ) -> None:
        """`torque_constant` [N·m/A], (n,); `limits`: MuJoCo's friction of all degrees of freedom
        [N·m], where `dofs` are those of the n rotors."""
        self._constant: list[float] = torque_constant.tolist()
        self._limits, self._dofs = limits, dofs
        self._coulomb: list[float] = limits[dofs].tolist()
        self._stribeck, self._load = plant.stribeck_friction, 2.0 * plant.load_friction

    def act(self, spins: list[float], currents: list[float]) -> None:
        """Rotor speeds [rad/s] and motor currents [A] of the substep to come."""
        stribeck, load, exp, unit = self._stribeck, self._load, math.exp, 1.0 / STRIBECK_VELOCITY
        self._limits[self._dofs] = [
            dry + (stribeck + load * k * abs(current)) * exp(-(abs(spin * unit) ** CURVATURE))
            for dry, spin, current, k in zip(
                self._coulomb, spins, currents, self._constant, strict=True
            )
        ]
