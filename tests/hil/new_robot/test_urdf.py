"""URDF as it is found: meshes by package names, no free root, limits with speeds."""

import json

import mujoco
import pytest
from typer.testing import CliRunner

from hil.cli.main import app
from hil.robot_files import load_robot

CHAIN = (
    ("hip_yaw", "0 0 1", 0.0),
    ("hip_roll", "1 0 0", 0.0),
    ("hip_pitch", "0 1 0", 0.0),
    ("knee", "0 1 0", -0.2),
    ("ankle_pitch", "0 1 0", -0.2),
    ("ankle_roll", "1 0 0", 0.0),
)
"""Joint, axis and drop from the one before [m]."""


def link(name, mass, shape=""):
    return (
        f'<link name="{name}"><inertial><mass value="{mass}"/><origin xyz="0 0 0"/>'
        f'<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>'
        f"</inertial>{shape}</link>"
    )


def collision(geometry, z=0.0):
    return f'<collision><origin xyz="0 0 {z}"/><geometry>{geometry}</geometry></collision>'


def urdf():
    """A robot of 20 kg that stands fixed to the world and has a mesh that is nowhere."""
    missing = collision('<mesh filename="package://nowhere/meshes/torso.stl"/>')
    text = '<robot name="big">' + link("base", 8.0, missing)
    for side, y in (("left", 0.1), ("right", -0.1)):
        parent = "base"
        for place, (name, axis, z) in enumerate(CHAIN):
            foot = collision('<box size="0.2 0.1 0.02"/>', -0.06) if name == "ankle_roll" else ""
            text += link(f"{side}_{name}_link", 1.0, foot)
            text += (
                f'<joint name="{side}_{name}" type="revolute"><parent link="{parent}"/>'
                f'<child link="{side}_{name}_link"/><origin xyz="0 {y if place == 0 else 0} {z}"/>'
                f'<axis xyz="{axis}"/><limit lower="-1.5" upper="1.5" effort="70" velocity="5.5"/>'
                "</joint>"
            )
            parent = f"{side}_{name}_link"
    return text + "</robot>"


@pytest.fixture
def made(tmp_path):
    source = tmp_path / "big.urdf"
    source.write_text(urdf())
    result = CliRunner().invoke(
        app, ["new-robot", str(source), "--out", str(tmp_path / "big"), "--json"]
    )
    assert result.exit_code == 0, result.output
    return tmp_path / "big" / "big.yaml", json.loads(result.stdout)["findings"]


def test_efforts_speeds_and_ranges_are_the_urdfs(made):
    file, _ = made
    knee = {joint.name: joint for joint in load_robot(str(file)).joints}["left_knee"]
    assert (knee.torque_limit, knee.velocity_limit) == (70.0, 5.5)
    assert knee.range == (-1.5, 1.5)


def test_the_root_is_set_free_and_the_missing_mesh_named(made):
    file, findings = made
    model = mujoco.MjModel.from_xml_path(str(file.with_suffix(".xml")))
    assert model.body("torso").subtreemass[0] == pytest.approx(20.0, rel=1e-4)
    said = " ".join(row["says"] for row in findings)
    assert "body base was set free" in said
    assert "package://nowhere/meshes/torso.stl" in said


def test_a_mesh_is_found_beside_the_package(tmp_path):
    """The box of the foot as a mesh in a folder above: the sole is the box's."""
    source = tmp_path / "pack" / "urdf" / "big.urdf"
    mesh = tmp_path / "pack" / "meshes" / "foot.obj"
    for path in (source, mesh):
        path.parent.mkdir(parents=True, exist_ok=True)
    corners = [(x, y, z) for x in (-0.1, 0.1) for y in (-0.05, 0.05) for z in (-0.01, 0.01)]
    faces = ["1 2 3", "2 4 3", "5 7 6", "6 7 8", "1 5 2", "2 5 6", "3 4 7", "4 8 7", "1 3 5",
             "3 7 5", "2 6 4", "4 6 8"]  # fmt: skip
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {face}" for face in faces]
    mesh.write_text("\n".join(lines) + "\n")
    box = '<box size="0.2 0.1 0.02"/>'
    source.write_text(urdf().replace(box, '<mesh filename="package://pack/meshes/foot.obj"/>'))
    out = tmp_path / "out"
    result = CliRunner().invoke(app, ["new-robot", str(source), "--out", str(out)])
    assert result.exit_code == 0, result.output
    model = mujoco.MjModel.from_xml_path(str(out / "big.xml"))
    assert model.geom("left_sole").size[:2] == pytest.approx([0.1, 0.05], abs=1e-6)
