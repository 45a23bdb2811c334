"""A controller of your own in the dry run: the small biped does knee bends.

Your controller gets an Estimate and returns a JointCommand; that is all. The real driver, the bus
and the physics behind it are the same as for walking.
"""

from dataclasses import replace
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from hil.compose import build
from hil.interface import Estimate, JointCommand, Reference, WalkStatus
from hil.request import RunRequest
from hil.run import run


class KneeBends:
    """Bends both legs by a few degrees, once in two seconds."""

    def __init__(self, joint_names: tuple[str, ...], start: tuple[float, ...]) -> None:
        self.status = WalkStatus(walking=True)
        self._start = np.array(start)
        self._shape = np.zeros(len(joint_names))
        for name, share in (("hip_pitch", -0.5), ("knee", 1.0), ("ankle_pitch", -0.5)):
            for side in ("left", "right"):
                self._shape[joint_names.index(f"{side}_{name}")] = share
        self._command = JointCommand.zeros(len(joint_names))
        self._command.stiffness[:] = 18.9
        self._command.damping[:] = 0.851
        self._first_ns: int | None = None

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The command of this tick."""
        del reference  # Knee bends have no speed.
        if self._first_ns is None:
            self._first_ns = estimate.time_ns
        phase = np.pi * (estimate.time_ns - self._first_ns) * 1e-9
        self._command.position[:] = self._start + 0.2 * (1 - np.cos(phase)) * self._shape
        self._command.velocity[:] = 0.2 * np.pi * np.sin(phase) * self._shape
        return self._command


folder = Path(mkdtemp()) / "run"
session = build(RunRequest(duration_s=4.0, out=folder))
description = session.description
mine = KneeBends(description.joint_names, description.start_position)
result = run(replace(session, controller=mine), progress=False)
print(f"fell: {result.report['fell']}, knees bent four seconds long; recorded in {result.folder}")
