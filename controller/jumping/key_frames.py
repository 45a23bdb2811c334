"""The iterates of a windup as key frames for a table program."""

import csv
import io
from collections.abc import Sequence

from controller.jumping.windup import WindupFrame

PLACE = ("base_x_m", "base_y_m", "base_z_m", "base_qw", "base_qx", "base_qy", "base_qz")
STATE = (
    "com_x_m", "com_y_m", "com_z_m", "muscle_force_n", "force_error_n",
    "balance_error_x_m", "balance_error_y_m", "margin_m",
)  # fmt: skip


def key_frames_csv(
    frames: Sequence[WindupFrame], joint_names: Sequence[str], frame_time: float
) -> str:
    """One line a frame: time, place of the root, balance and force, then every joint [rad].

    `frame_time` [s] is from one frame to the next.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    joints = [f"{name}_rad" for name in joint_names]
    writer.writerow(["frame", "time_s", *PLACE, *STATE, *joints])
    for number, frame in enumerate(frames):
        posture = frame.posture
        values = [*posture.base_position, *posture.base_orientation, *frame.com, frame.force]
        values += [frame.force_error, *frame.balance_error, frame.margin, *posture.joint_position]
        row = [f"{value:.7g}" for value in (number * frame_time, *values)]
        writer.writerow([number, *row])
    return text.getvalue()
