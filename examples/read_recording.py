"""A recorded run as numpy arrays: walk two seconds, then read every tick back."""

from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from hil.compose import build
from hil.recording import read_recording
from hil.request import RunRequest
from hil.run import run

folder = Path(mkdtemp()) / "run"
run(build(RunRequest(duration_s=2.0, out=folder)), progress=False)
rows = read_recording(folder).rows
print("topics:", ", ".join(rows.dtype.names or ()))
error = rows["command"]["position"] - rows["frame"]["joint_position"]
print(f"{len(rows)} ticks, tracking error rms {np.sqrt(np.mean(error**2)):.3f} rad")
