"""Friction that fades with speed and grows with load, against the published identification."""

import numpy as np
import pytest

from hil.twin import Plant as PlantSettings
from sim_backends.gear_friction import GearFriction
from tests.sim_backends.conftest import run

KNEE = 3
BASE, STRIBECK, LOAD = 0.0615, 0.0239, 0.2343
"""MX-64, model m4 (Rhoban bam, params/mx64/m4.json) [N·m], [N·m], [1]."""


def friction(spin, torque):
    settings = PlantSettings(floor_friction=1.0, stribeck_friction=STRIBECK, load_friction=LOAD)
    limits = np.array([0.0, BASE])
    gears = GearFriction(settings, np.array([2.0]), limits, slice(1, 2))
    gears.act([spin], [torque / 2.0])
    assert limits[0] == 0.0
    return limits[1]


def test_at_rest_it_is_base_stribeck_and_load_together():
    assert friction(0.0, 0.0) == pytest.approx(BASE + STRIBECK)
    assert friction(0.0, -1.0) == pytest.approx(BASE + STRIBECK + LOAD * 2.0)


def test_it_fades_to_the_base_as_the_joint_moves():
    """At the Stribeck velocity 1/e is left; at four times that, nearly nothing."""
    assert friction(1.52, 1.0) == pytest.approx(BASE + (STRIBECK + 2 * LOAD) / np.e, rel=1e-3)
    assert friction(-1.52, 1.0) == friction(1.52, 1.0)
    assert friction(6.0, 1.0) == pytest.approx(BASE, abs=2e-3)


@pytest.mark.parametrize("gap", [0.0, 0.01])
def test_a_loaded_joint_sticks(in_the_air, gap):
    """Under load it takes a larger change of torque to move it, with and without backlash."""
    moves = []
    for overrides in ((), (f"load_friction={LOAD}", f"stribeck_friction={STRIBECK}")):
        plant = in_the_air("joint_friction=0.0615", f"backlash={gap}", *overrides)
        plant.data.qfrc_applied[6 + KNEE] = 1.5
        run(plant, 1.0)
        before = plant.joint_position[KNEE]
        plant.data.qfrc_applied[6 + KNEE] = 1.2
        run(plant, 1.0)
        moves.append(abs(plant.joint_position[KNEE] - before))
    assert moves[0] > 0.008
    assert moves[1] < 0.3 * moves[0]


def test_viscous_friction_lowers_the_top_speed(in_the_air):
    """Turning freely: k·(V − k·ω)/r = b·ω."""
    speeds = []
    for viscous in (0.0, 0.2):
        plant = in_the_air("joint_friction=0", "armature=0.001", f"viscous_friction={viscous}")
        plant.servos.goal[0] += 800
        peak = 0.0
        for _ in range(300):
            plant.substep()
            peak = max(peak, float(plant.joint_velocity[0]))
        speeds.append(peak)
    k2_r = 4.1 / (46 * 2 * np.pi / 60)
    assert speeds[1] / speeds[0] == pytest.approx(k2_r / (k2_r + 0.2), rel=0.05)
