"""Where every number of minibiped's body comes from, and the MJCF made of them.

`python -m hil.robots.minibiped.derivation > hil/robots/minibiped/minibiped.xml` writes the model;
a test holds the checked-in file to this output. Lengths in m, masses in kg, inertias follow from
boxes of the given mass and size. The parts are listed with their sources in `README.md`.
"""

from dataclasses import dataclass

## Catalogue figures.

SERVO_MASS = 0.082
"""XM430-W350-T, e-manual, specifications: 82 g."""
SERVO_SIZE = (0.0285, 0.0465, 0.0340)
"""XM430-W350-T, e-manual, specifications: 28.5 x 46.5 x 34.0 mm."""
SERVO_ARMATURE = 0.030
"""Reflected rotor inertia [kg·m²]; assumed: public values of this class go from .0012 to .045."""
SERVO_FRICTION = 0.10
"""Dry friction [N·m]; assumed: public values of this class go from .03 to .29."""

## Geometry of the legs. Hip axes meet in one point, ankle axes in another: closed-form IK.

HIP_HALF_SPACING = 0.045
THIGH = 0.110
SHANK = 0.110
ANKLE_HEIGHT = 0.036
"""Ankle axes above the bottom of the sole."""
SOLE_FRONT, SOLE_REAR = 0.070, -0.050
"""Ends of the sole, forward of the ankle axis."""
SOLE_HALF_WIDTH = 0.036
SOLE_THICKNESS = 0.012

RANGES = {
    "hip_yaw": (-0.8, 0.8),
    "hip_roll": (-0.7, 0.7),
    "hip_pitch": (-1.8, 0.9),
    "knee": (0.02, 2.3),
    "ankle_pitch": (-1.4, 0.9),
    "ankle_roll": (-0.7, 0.7),
}
"""Joint ranges [rad] that the brackets allow without touching."""
AXES = {
    "hip_yaw": "0 0 1",
    "hip_roll": "1 0 0",
    "hip_pitch": "0 1 0",
    "knee": "0 1 0",
    "ankle_pitch": "0 1 0",
    "ankle_roll": "1 0 0",
}


@dataclass(frozen=True)
class Part:
    """A box of known mass, placed in its body's frame."""

    name: str
    mass: float
    position: tuple[float, float, float]
    size: tuple[float, float, float]
    """Full edge lengths."""
    material: str = "plate"


TORSO = (
    Part("pelvis", 2 * SERVO_MASS + 0.211, (0, 0, 0.045), (0.060, 0.130, 0.050)),
    Part("battery_and_computer", 0.575, (-0.005, 0, 0.110), (0.070, 0.110, 0.080), "shell"),
    Part("left_arm", 0.100, (0, 0.080, 0.080), (0.035, 0.030, 0.130), "servo"),
    Part("right_arm", 0.100, (0, -0.080, 0.080), (0.035, 0.030, 0.130), "servo"),
    Part("head", 0.100, (0.005, 0, 0.205), (0.060, 0.080, 0.070), "shell"),
)
"""Pelvis with both yaw servos and frame; 3S 2200 mAh pack 190 g, computer 90 g, power board, two
USB adapters, IMU and shell; arms are fixed."""

_along_x = (SERVO_SIZE[1], SERVO_SIZE[0], SERVO_SIZE[2])
LEG = {
    "hip_yaw": (Part("hip_yaw_link", SERVO_MASS + 0.020, (-0.010, 0, 0.030), _along_x, "servo"),),
    "hip_roll": (Part("hip_roll_link", SERVO_MASS + 0.020, (0, 0, 0), SERVO_SIZE, "servo"),),
    "hip_pitch": (
        Part("thigh_frame", 0.050, (0, 0, -0.045), (0.026, 0.036, 0.070)),
        Part("knee_servo", SERVO_MASS, (0, 0, -0.090), SERVO_SIZE, "servo"),
    ),
    "knee": (
        Part("shank_frame", 0.045, (0, 0, -0.040), (0.024, 0.034, 0.060)),
        Part("ankle_pitch_servo", SERVO_MASS, (0, 0, -0.085), SERVO_SIZE, "servo"),
    ),
    "ankle_pitch": (
        Part("ankle_roll_servo", SERVO_MASS + 0.015, (-0.008, 0, 0), _along_x, "servo"),
    ),
}
"""Parts carried by each leg joint; the sole is the last one."""
SOLE_MASS = 0.125
"""Aluminium plate 120 x 72 x 3 mm (70 g), four load cells (32 g), foot board and pad (23 g)."""


def _box(part: Part, name: str) -> str:
    half = " ".join(f"{edge / 2:.5g}" for edge in part.size)
    position = " ".join(f"{value:.5g}" for value in part.position)
    return (
        f'<geom name="{name}" type="box" class="part" mass="{part.mass:.4g}" '
        f'pos="{position}" size="{half}" material="{part.material}"/>'
    )


def _sole(side: str) -> str:
    length = SOLE_FRONT - SOLE_REAR
    return (
        f'<geom name="{side}_sole" type="box" class="sole" mass="{SOLE_MASS}" '
        f'pos="{(SOLE_FRONT + SOLE_REAR) / 2:.5g} 0 '
        f'{-ANKLE_HEIGHT + SOLE_THICKNESS / 2:.5g}" '
        f'size="{length / 2:.5g} {SOLE_HALF_WIDTH:.5g} {SOLE_THICKNESS / 2:.5g}"/>'
    )


def _leg(side: str, sign: int) -> list[str]:
    places = {
        "hip_yaw": f"0 {sign * HIP_HALF_SPACING:.5g} 0",
        "knee": f"0 0 {-THIGH:.5g}",
        "ankle_pitch": f"0 0 {-SHANK:.5g}",
    }
    bodies = {
        "hip_yaw": "hip_yaw_link",
        "hip_roll": "hip_roll_link",
        "hip_pitch": "thigh",
        "knee": "shank",
        "ankle_pitch": "ankle",
        "ankle_roll": "foot",
    }
    lines = []
    for depth, (joint, axis) in enumerate(AXES.items()):
        pad = "  " * (3 + depth)
        low, high = RANGES[joint]
        place = f' pos="{places[joint]}"' if joint in places else ""
        lines.append(f'{pad}<body name="{side}_{bodies[joint]}"{place}>')
        lines.append(f'{pad}  <joint name="{side}_{joint}" axis="{axis}" range="{low} {high}"/>')
        lines += [f"{pad}  {_box(part, f'{side}_{part.name}')}" for part in LEG.get(joint, ())]
    lines.append("  " * 9 + _sole(side))
    lines += ["  " * (3 + depth) + "</body>" for depth in reversed(range(len(AXES)))]
    return lines


def mjcf() -> str:
    """The whole model as MJCF. Actuators are added by the plant from each joint's servo."""
    lines = [
        "<!-- Written by hil/robots/minibiped/derivation.py: change the numbers there. -->",
        '<mujoco model="minibiped">',
        '  <compiler angle="radian" autolimits="true"/>',
        '  <option cone="elliptic" impratio="10" integrator="implicitfast" jacobian="dense"/>',
        "  <default>",
        f'    <joint type="hinge" armature="{SERVO_ARMATURE}" frictionloss="{SERVO_FRICTION}"/>',
        '    <geom friction="0.9 0.005 0.0001" solref="0.01 1"/>',
        '    <default class="part"><geom contype="0" conaffinity="0"/></default>',
        '    <default class="sole">'
        '<geom contype="0" conaffinity="1" condim="4" material="pad"/></default>',
        "  </default>",
        "  <asset>",
        '    <material name="plate" rgba="0.55 0.58 0.62 1"/>',
        '    <material name="shell" rgba="0.92 0.55 0.20 1"/>',
        '    <material name="servo" rgba="0.16 0.17 0.19 1"/>',
        '    <material name="pad" rgba="0.30 0.30 0.32 1"/>',
        "  </asset>",
        "  <worldbody>",
        '    <geom name="floor" type="plane" size="0 0 .05" contype="1" conaffinity="0" '
        'condim="4" rgba="0.86 0.87 0.88 1"/>',
        '    <light pos="0 -1 2" dir="0 0.4 -1" diffuse="0.8 0.8 0.8"/>',
        f'    <body name="torso" pos="0 0 {ANKLE_HEIGHT + THIGH + SHANK:.5g}">',
        '      <freejoint name="root"/>',
        '      <site name="imu" pos="0 0 0.080" size="0.005"/>',
        *(f"      {_box(part, part.name)}" for part in TORSO),
        *_leg("left", 1),
        *_leg("right", -1),
        "    </body>",
        "  </worldbody>",
        "</mujoco>",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(mjcf(), end="")
