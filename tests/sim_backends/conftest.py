"""Plants of both robots, and a servo robot's goals as the driver would make them."""

import numpy as np
import pytest

from hil.robot_files import load_robot
from hil.servo import CENTRE_COUNTS, COUNTS_PER_RADIAN, ServoGoals
from sim_backends.plant import Plant
from sim_backends.virtual.motors import nominal_motors

RATE = 300
NOMINAL = "plant.draws=null"


@pytest.fixture(scope="session")
def minibiped():
    """The robot as its data sheets have it, with nothing hidden."""
    return load_robot("minibiped", (NOMINAL,))


@pytest.fixture
def make_plant(minibiped):
    def make(*overrides, rate=RATE, seed=0):
        overrides = (NOMINAL, *overrides)
        description = load_robot("minibiped", overrides) if overrides[1:] else minibiped
        return Plant(description, rate, seed, nominal_motors(description))

    return make


@pytest.fixture
def in_the_air(make_plant):
    """A plant held off the floor without sag, its servos on; no weight moves it, or its own."""

    def make(*overrides, settle_s=0.2, gravity=False):
        plant = make_plant("supply.resistance=0.0", *overrides)
        plant.data.qpos[2] += 1.0
        if not gravity:
            plant.model.opt.gravity[:] = 0.0
        plant.set_support(True)
        hold(plant)
        run(plant, settle_s)
        return plant

    return make


def goals_at(angles, p_gain=800, pwm_limit=885):
    """Register values that hold joint angles [rad], all servos turning the joint's way."""
    n = len(angles)
    counts = np.rint(np.asarray(angles) * COUNTS_PER_RADIAN + CENTRE_COUNTS).astype(int)
    return ServoGoals(counts, np.full(n, p_gain), np.zeros(n, int), np.full(n, pwm_limit))


def hold(plant, angles=None):
    """Torque on, holding the start pose or other angles."""
    angles = plant.description.start_position if angles is None else angles
    plant.servos.set_goals(goals_at(angles))
    for servo in range(len(angles)):
        plant.servos.set_enabled(servo, True)


def run(plant, seconds):
    for _ in range(round(seconds * plant.rate_hz)):
        plant.step()
