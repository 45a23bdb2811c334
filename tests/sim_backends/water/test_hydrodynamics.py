"""The liquid against closed forms: floating depth, terminal speed, and energy that never grows."""

import math

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil.robot_facts import robot_facts
from hil.robot_files import load_robot
from sim_backends.plant import Plant
from sim_backends.water.drag_torque import DragTorque
from sim_backends.water.hydrodynamics import Hydrodynamics
from sim_backends.water.immersion import CELLS_A_LEG
from sim_backends.water.surface import body_surface

DENSITY, GRAVITY = 1000.0, 9.81


def pool(geom: str, mass: float, step: float = 0.002, height: float = 0.0, cell: float = 0.02):
    """A free body of one geom, its centre at a height; the liquid around it."""
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{step}"/><worldbody>
        <body name="body" pos="0 0 {height}"><freejoint/><geom {geom} mass="{mass}"
        contype="0" conaffinity="0"/></body></worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    return model, data, Hydrodynamics(model, data, 1, cell)


def settle(model, data, water, seconds):
    for _ in range(round(seconds / model.opt.timestep)):
        mujoco.mj_step1(model, data)
        water.act()
        mujoco.mj_step2(model, data)
        water.withdraw()


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9])
def test_a_sphere_floats_at_the_depth_of_archimedes(share):
    radius = 0.12
    mass = share * DENSITY * 4.0 / 3.0 * math.pi * radius**3
    model, data, water = pool(f'type="sphere" size="{radius}"', mass, step=0.005, height=1.0)
    water.set_medium(1.0, DENSITY, 50.0)  # thick, or it bobs for minutes
    settle(model, data, water, 10.0)
    # π·d²(3r − d)/3 = m/ρ for the depth d of the lowest point under the level
    roots = np.roots([-math.pi / 3.0, math.pi * radius, 0.0, -mass / DENSITY]).real
    depth = next(root for root in roots if 0.0 < root < 2.0 * radius)
    assert 1.0 - (data.qpos[2] - radius) == pytest.approx(depth, abs=0.015 * radius)


@pytest.mark.parametrize(
    ("geom", "volume", "shown"),
    [
        ('type="sphere" size="0.1"', 4 / 3 * math.pi * 1e-3, math.pi * 0.01),
        ('type="box" size="0.1 0.05 0.02"', 8e-4, 0.02),
        (
            'type="capsule" size="0.05 0.2" quat="1 1 0 0"',
            math.pi * 0.0025 * 0.4 + 4 / 3 * math.pi * 0.05**3,
            0.1 * 0.4 + math.pi * 0.0025,
        ),
    ],
    ids=["sphere", "box on its face", "capsule on its side"],
)
@pytest.mark.parametrize("viscosity", [1.0, 4.0])
def test_a_sinking_body_reaches_its_terminal_speed(geom, volume, shown, viscosity):
    mass = 2.0 * DENSITY * volume
    model, data, water = pool(geom, mass, height=-1.0)
    water.set_medium(100.0, DENSITY, viscosity)
    settle(model, data, water, 3.0)
    # ½ρμv²·A = (m − ρV)g
    speed = math.sqrt(2.0 * (mass - DENSITY * volume) * GRAVITY / (DENSITY * viscosity * shown))
    assert -data.qvel[2] == pytest.approx(speed, rel=0.01)


def test_a_body_in_the_air_feels_nothing_and_half_a_box_feels_half_its_lift():
    model, data, water = pool('type="box" size="0.1 0.1 0.1"', 1.0, height=1.0)
    for level, lift in ((0.89, 0.0), (1.0, 0.5), (1.05, 0.75), (2.0, 1.0)):
        water.set_medium(level, DENSITY, 1.0)
        mujoco.mj_step1(model, data)
        water.act()
        assert data.xfrc_applied[1, 2] == pytest.approx(lift * DENSITY * GRAVITY * 0.008)
        water.withdraw()


def human_in_water(rng, level: float, viscosity: float, rate: int):
    plant = Plant(load_robot("human"), rate)
    plant.set_medium(level, DENSITY, viscosity)
    plant.data.qpos[7:] += rng.uniform(-0.5, 0.5, plant.model.nq - 7)
    plant.data.qvel[:] = rng.normal(0.0, 5.0, plant.model.nv)
    mujoco.mj_step1(plant.model, plant.data)
    return plant, plant.immersion.water


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    level=st.floats(0.05, 2.0),
    viscosity=st.floats(0.1, 100.0),
    rate=st.sampled_from([60, 225, 300]),
)
def test_the_drag_of_a_step_never_adds_energy(seed, level, viscosity, rate):
    """hQ·q̇ + ½h²·QᵀM⁻¹Q ≤ 0 for the joint forces Q of the drag, whatever the robot does."""
    plant, water = human_in_water(np.random.default_rng(seed), level, viscosity, rate)
    model, data = plant.model, plant.data
    water.act()
    joint_forces = np.zeros(model.nv)
    for body, (force, torque) in zip(water.bodies, water.wrenches, strict=True):
        place = data.xipos[body]
        mujoco.mj_applyFT(model, data, force, torque, place, int(body), joint_forces)
    moved = np.zeros((1, model.nv))
    mujoco.mj_solveM(model, data, moved, joint_forces[None])
    step = model.opt.timestep
    gain = step * joint_forces @ data.qvel + 0.5 * step**2 * joint_forces @ moved[0]
    assert gain <= 1e-9


def test_without_the_limit_a_thick_liquid_would_add_energy():
    """The property above can fail: it does so for the same forces without their limit."""
    model, data, water = pool('type="box" size="0.02 0.02 0.002"', 0.02, step=1 / 60)
    water.set_medium(100.0, DENSITY, 50.0)
    data.qvel[2] = -3.0
    mujoco.mj_step1(model, data)
    water.act()
    limited = water.wrenches[0, 0, 2]
    free = 0.5 * DENSITY * 50.0 * 9.0 * 0.0016
    assert limited == pytest.approx(0.02 * 3.0 * 60.0)  # stops it in one step
    assert free > 2.0 * limited


def test_the_wrench_is_the_sum_over_the_elements():
    plant, water = human_in_water(np.random.default_rng(3), 0.6, 1.0, 300)
    model, data = plant.model, plant.data
    water.act()
    cell = robot_facts(plant.description).leg_length / CELLS_A_LEG
    for body, (force, torque) in zip(water.bodies, water.wrenches, strict=True):
        surface = body_surface(model, int(body), cell)
        axes, origin = data.ximat[body].reshape(3, 3), data.xipos[body]
        twist = np.empty(6)
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, int(body), twist, 0)
        velocity = twist[3:] + np.cross(twist[:3], origin - data.xpos[body])
        total, moment = np.zeros(3), np.zeros(3)
        for p, n, area in zip(surface.points, surface.normals, surface.areas, strict=True):
            lever = axes @ p
            u = velocity + np.cross(twist[:3], lever)
            wet = min(max((0.6 - (origin + lever)[2]) / cell + 0.5, 0.0), 1.0)
            f = -0.5 * DENSITY * area * wet * max(axes @ n @ u, 0.0) * u
            total += f
            moment += np.cross(lever, f)
        np.testing.assert_allclose(force, total, rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose(torque, moment, rtol=1e-6, atol=1e-9)


def test_a_push_stays_what_it_is_while_the_liquid_acts():
    plant = Plant(load_robot("human"), 300)
    plant.set_medium(1.0, DENSITY, 1.0)
    push = np.array([30.0, -20.0, 5.0])
    plant.set_push(push)
    for _ in range(3):
        plant.step()
    np.testing.assert_array_equal(plant.data.xfrc_applied[1, :3], push)
    assert not plant.data.xfrc_applied[2:].any()


def test_dropped_into_the_liquid_a_body_loses_energy_all_the_way():
    """Kinetic, gravitational and buoyant energy together: ρV over the depth, by integration."""
    model, data, water = pool('type="box" size="0.1 0.1 0.1"', 4.0, step=0.001, height=1.3)
    water.set_medium(1.0, DENSITY, 1.0)
    energies = []
    for _ in range(3000):
        settle(model, data, water, 0.001)
        z, v = float(data.qpos[2]), float(data.qvel[2])
        under = min(max(1.0 - (z - 0.1), 0.0), 0.2)
        buoyant = DENSITY * GRAVITY * 0.04 * under**2 / 2.0
        if 1.0 - z > 0.1:
            buoyant += DENSITY * GRAVITY * 0.008 * (1.0 - z - 0.1)
        energies.append(0.5 * 4.0 * v * v + 4.0 * GRAVITY * z + buoyant)
    assert np.diff(energies).max() < 2e-2  # the integrator's own, of an energy of 51 J
    assert energies[-1] == pytest.approx(4.0 * GRAVITY + DENSITY * GRAVITY * 2e-4, rel=0.01)


def test_drag_turns_a_limb_about_the_joint_it_hangs_on():
    """A plate of 0.2 × 0.4 m swung about its upper edge: ∫½ρ(ωr)²·w·r·dr = ½ρω²w·l⁴/4."""
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><option timestep="0.001" gravity="0 0 0"/><worldbody><body name="root">
        <freejoint/><geom type="box" size="0.1 0.1 0.01" mass="1e6" contype="0"/>
        <body name="limb"><joint name="hinge" type="hinge" axis="0 1 0"/><geom type="box"
        size="0.001 0.1 0.2" pos="0 0 -0.2" mass="5" contype="0"/></body></body></worldbody>
        </mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qvel[-1] = 0.5
    water = Hydrodynamics(model, data, 1, 0.01)
    water.set_medium(2.0, DENSITY, 1.0)
    mujoco.mj_step1(model, data)
    water.act()
    swung = 0.5 * DENSITY * 0.5**2 * 0.2 * 0.4**4 / 4.0
    assert DragTorque(model, data, 1, water).total() == pytest.approx(swung, rel=0.02)


def test_a_liquid_that_comes_and_goes_is_prepared_once():
    """Cutting a robot into elements takes many ticks: a running walk must not wait for it."""
    plant = Plant(load_robot("human"), 300)
    plant.set_medium(0.0, DENSITY, 1.0)
    assert plant.immersion.water is None
    plant.set_medium(0.5, DENSITY, 1.0)
    first = plant.immersion.water
    plant.set_medium(0.0, DENSITY, 1.0)
    plant.immersion.step()
    plant.set_medium(0.7, DENSITY, 1.0)
    assert plant.immersion.water is first


def test_dry_land_drags_at_no_joint():
    plant = Plant(load_robot("human"), 300)
    assert plant.immersion.drag_torque() == 0.0
    plant.set_medium(0.5, DENSITY, 1.0)
    plant.data.qvel[0] = 1.0
    plant.immersion.step()
    assert plant.immersion.drag_torque() > 1.0
