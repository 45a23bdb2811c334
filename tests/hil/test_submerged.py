"""Submerged volumes against the closed forms of caps, segments and wedges."""

import math

import mujoco
import numpy as np
import pytest

from hil.errors import InputError
from hil.submerged import SubmergedParts


def parts(geom: str, cell: float):
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1"/>
        <body name="robot"><freejoint/><geom {geom} mass="1"/></body></worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return SubmergedParts(model, data, 1, cell)


def cap(radius: float, depth: float) -> float:
    return math.pi * depth**2 * (3.0 * radius - depth) / 3.0


@pytest.mark.parametrize("level", [-0.09, -0.04, 0.0, 0.03, 0.08])
def test_a_sphere_is_cut_like_a_cap(level):
    sphere = parts('type="sphere" size="0.1"', 0.02)
    sphere.update(level)
    whole = 4.0 / 3.0 * math.pi * 0.001
    depth = level + 0.1
    assert sphere.volumes[0] == pytest.approx(cap(0.1, depth), abs=0.005 * whole)
    # centroid of a cap, from the centre: −3(2r − d)²/(4(3r − d))
    centroid = -3.0 * (0.2 - depth) ** 2 / (4.0 * (0.3 - depth))
    assert sphere.centres[0, 2] == pytest.approx(centroid, abs=0.007)
    assert np.abs(sphere.centres[0, :2]).max() < 1e-9


@pytest.mark.parametrize("level", [-0.04, -0.01, 0.02, 0.045])
def test_a_lying_capsule_is_cut_like_a_segment(level):
    capsule = parts('type="capsule" size="0.05 0.2" quat="1 1 0 0"', 0.02)
    capsule.update(level)
    segment = 0.05**2 * math.acos(-level / 0.05) + level * math.sqrt(0.05**2 - level**2)
    exact = 0.4 * segment + cap(0.05, level + 0.05)
    assert capsule.volumes[0] == pytest.approx(exact, abs=0.01 * float(capsule._whole[0]))


@pytest.mark.parametrize("level", [-0.21, 0.013, 0.19, 0.23])
def test_a_standing_capsule_is_cut_across(level):
    capsule = parts('type="capsule" size="0.05 0.2"', 0.02)
    capsule.update(level)
    lower = cap(0.05, min(max(level + 0.25, 0.0), 0.05))
    barrel = math.pi * 0.0025 * min(max(level + 0.2, 0.0), 0.4)
    upper = 0.0 if level < 0.2 else cap(0.05, 0.05) - cap(0.05, 0.25 - level)
    whole = float(capsule._whole[0])
    assert capsule.volumes[0] == pytest.approx(lower + barrel + upper, abs=0.004 * whole)


def test_an_upright_box_is_exact_at_every_level():
    box = parts('type="box" size="0.0725 0.025 0.019"', 0.04)
    for level in np.linspace(-0.03, 0.03, 13):
        box.update(float(level))
        share = min(max((level + 0.019) / 0.038, 0.0), 1.0)
        assert box.volumes[0] == pytest.approx(share * 8 * 0.0725 * 0.025 * 0.019)


def test_a_box_on_its_edge_converges_to_the_wedge():
    errors = []
    for cell in (0.1, 0.05, 0.025):
        box = parts('type="box" size="0.1 0.1 0.1" euler="45 0 0"', cell)
        box.update(-0.08)
        depth = 0.1 * math.sqrt(2.0) - 0.08
        errors.append(abs(box.volumes[0] / (depth * depth * 0.2) - 1.0))
    assert errors[2] < 0.004
    assert errors[2] < 0.3 * errors[0]


def test_other_shapes_are_refused_by_name():
    with pytest.raises(InputError, match="'fin': water needs boxes, capsules and spheres"):
        parts('name="fin" type="ellipsoid" size="0.1 0.1 0.1"', 0.02)
