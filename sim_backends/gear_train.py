"""Backlash: the motor's side of a gear train as a body of its own, a gap away from the joint."""

import mujoco

ROTOR = "_rotor"
"""What the name of a joint's rotor adds to the joint's."""
_SOLREF = (0.002, 1.0)
"""Time constant of the teeth [s] and damping ratio: the stiffest that substeps near 1 ms bear, so
the gear train itself is rigid (assumed)."""
_SOLIMP = (0.98, 0.999, 0.001, 0.5, 2.0)
_NO_INERTIA = 1e-9
"""[kg] and [kg·m²]: the rotor's inertia is its joint's armature."""


def add_rotor(spec: mujoco.MjSpec, name: str, gap: float) -> str:
    """Put the motor of joint `name` behind a gap [rad]; the name of the rotor's joint.

    With rotor angle θ and joint angle q the teeth touch at |q − θ| = gap/2:

        J·θ̈ = τ_motor − τ_friction − λ,      M·q̈ + … = λ,      λ ≠ 0 only in touch

    J is the reflected rotor inertia (armature), which the joint itself no longer has. The encoder
    of an X-series servo sits on the horn (contactless absolute encoder at the output), so it
    measures q, and the servo's loop has the gap inside. The rotor hangs in the world and acts
    through a limited tendon, whose force is internal between a joint's two bodies, as that of
    `armature` is; rotors turn about their own axes only, so nothing else couples them.
    """
    rotor = name + ROTOR
    body = spec.worldbody.add_body(
        name=rotor, mass=_NO_INERTIA, inertia=[_NO_INERTIA] * 3, explicitinertial=True
    )
    body.add_joint(name=rotor, type=mujoco.mjtJoint.mjJNT_HINGE, axis=[1, 0, 0])
    tendon = spec.add_tendon(name=name + "_gap", limited=True, range=[-gap / 2, gap / 2])
    tendon.solref_limit, tendon.solimp_limit = list(_SOLREF), list(_SOLIMP)
    tendon.wrap_joint(name, 1.0)
    tendon.wrap_joint(rotor, -1.0)
    return rotor
