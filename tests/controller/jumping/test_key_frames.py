"""The files for animators, read back by a reader of this test's own."""

import csv
import io
import math

import numpy as np
import pytest
from jump_robots import ROBOTS, jumper

from controller.jumping.bvh import bvh_text
from controller.jumping.key_frames import key_frames_csv
from controller.jumping.muscle_laws import MITRE
from controller.jumping.muscles import Muscles
from controller.jumping.posture import Posture
from controller.jumping.skeleton import Skeleton
from controller.jumping.windup import WindupSettings, wind_up

FRAME_TIME = 1.0 / 30.0


class BvhReader:
    """Reads the hierarchy token by token, and places it by the channels in their own order."""

    def __init__(self, text):
        head, motion = text.split("MOTION\n")
        self.tokens = head.split()
        self.names, self.parents, self.offsets, self.channels = [], [], [], []
        assert self.tokens.pop(0) == "HIERARCHY"
        assert self.tokens[0] == "ROOT"
        self.read(-1)
        assert not self.tokens
        frames, frame_time, *lines = motion.splitlines()
        self.count = int(frames.removeprefix("Frames:"))
        self.frame_time = float(frame_time.removeprefix("Frame Time:"))
        self.frames = np.array([[float(number) for number in line.split()] for line in lines])
        assert self.frames.shape == (self.count, sum(map(len, self.channels)))

    def read(self, parent):
        kind, name = self.tokens.pop(0), self.tokens.pop(0)
        assert (kind == "End") == (name == "Site")
        assert self.tokens.pop(0) == "{" and self.tokens.pop(0) == "OFFSET"
        self.names.append(name)
        self.parents.append(parent)
        self.offsets.append(np.array([float(self.tokens.pop(0)) for _ in range(3)]))
        self.channels.append([])
        this = len(self.names) - 1
        if kind != "End":
            assert self.tokens.pop(0) == "CHANNELS"
            self.channels[this] = [self.tokens.pop(0) for _ in range(int(self.tokens.pop(0)))]
        while self.tokens[0] in ("JOINT", "End"):
            self.read(this)
        assert self.tokens.pop(0) == "}"

    def places(self, frame):
        """Where every node is, in the file's axes."""
        numbers = iter(self.frames[frame].tolist())
        places, rotations = [], []
        for parent, offset, channels in zip(self.parents, self.offsets, self.channels, strict=True):
            above = np.eye(3) if parent < 0 else rotations[parent]
            place = offset.copy() if parent < 0 else places[parent] + above @ offset
            turned = above
            for channel in channels:
                axis, number = "XYZ".index(channel[0]), next(numbers)
                if channel.endswith("position"):
                    place[axis] += number
                else:
                    turned = turned @ turn(axis, math.radians(number))
            places.append(place)
            rotations.append(turned)
        return places


def turn(axis, angle):
    matrix = np.eye(3)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix[first, first] = matrix[second, second] = math.cos(angle)
    matrix[second, first] = math.sin(angle)
    matrix[first, second] = -math.sin(angle)
    return matrix


def wound(robot):
    muscles = Muscles.of(robot.model, robot.description, MITRE)
    force = 1.6 * robot.model.weight
    return wind_up(
        robot.model, robot.description, robot.start, force, muscles, WindupSettings()
    ).frames


def random_postures(robot, count):
    """Far from the start, the root turned about all axes."""
    rng = np.random.default_rng(5)
    limits = np.array([joint.range for joint in robot.description.joints])
    for _ in range(count):
        turned = rng.normal(size=4)
        yield Posture(rng.normal(size=3), turned / np.linalg.norm(turned), rng.uniform(*limits.T))


@pytest.mark.parametrize("name", ROBOTS)
def test_the_bvh_places_every_joint_where_the_robots_model_has_it(name):
    robot = jumper(name)
    postures = [frame.posture for frame in wound(robot)][::4] + list(random_postures(robot, 5))
    file = BvhReader(bvh_text(Skeleton(robot.model), postures, FRAME_TIME))
    assert file.count == len(postures)
    assert file.frame_time == pytest.approx(FRAME_TIME, abs=1e-6)
    # Every hinge must be at one of the file's joints: those that meet are one ball joint.
    inner = [place for place, channels in enumerate(file.channels) if channels]
    for frame, posture in enumerate(postures):
        robot.model.set_state(posture)
        nodes = np.array([file.places(frame)[place] for place in inner])[:, [2, 0, 1]]
        assert nodes[0] == pytest.approx(posture.base_position, abs=1e-5)
        for anchor in robot.model.data.xanchor[robot.model.joint_ids]:
            assert np.linalg.norm(nodes - anchor, axis=1).min() < 1e-4


@pytest.mark.parametrize("name", ROBOTS)
def test_what_the_bones_carry_turns_with_them(name):
    """The ends of the file's chains are where the model has the last geoms."""
    robot = jumper(name)
    [posture] = random_postures(robot, 1)
    file = BvhReader(bvh_text(Skeleton(robot.model), [posture], FRAME_TIME))
    ends = [
        (file.names[file.parents[node]], np.array(file.places(0)[node])[[2, 0, 1]])
        for node, channels in enumerate(file.channels)
        if not channels
    ]
    robot.model.set_state(posture)
    model, data = robot.model.model, robot.model.data
    assert {"left", "right"} <= {bone.split("_")[0] for bone, _ in ends}
    for bone, end in ends:
        geom = int(model.body(bone).geomadr[0])
        assert end == pytest.approx(data.geom_xpos[geom], abs=1e-4)


@pytest.mark.parametrize("name", ROBOTS)
def test_the_key_frames_hold_postures_and_errors(name):
    robot = jumper(name)
    frames = wound(robot)
    names = robot.description.joint_names
    lines = list(csv.DictReader(io.StringIO(key_frames_csv(frames, names, FRAME_TIME))))
    assert len(lines) == len(frames)
    for number, (line, frame) in enumerate(zip(lines, frames, strict=True)):
        assert int(line["frame"]) == number
        assert float(line["time_s"]) == pytest.approx(number * FRAME_TIME, rel=1e-5)
        angles = [float(line[f"{joint}_rad"]) for joint in names]
        assert angles == pytest.approx(frame.posture.joint_position, abs=1e-6)
        assert float(line["muscle_force_n"]) + float(line["force_error_n"]) == pytest.approx(
            1.6 * robot.model.weight, rel=1e-5
        )
        assert float(line["com_z_m"]) == pytest.approx(frame.com[2], rel=1e-5)
