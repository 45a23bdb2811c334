"""Walk, jump, walk on: a jump between two walks (composable controllers)."""

from dataclasses import replace
from typing import Literal

from controller.jumping.jump_controller import JumpController
from controller.jumping.jump_plan import JumpPlan
from hil.interface import Controller, Estimate, JointCommand, Reference

LAST_SPEED = 0.066
"""Of the last steps, in √(gL): what a crouch between two feet can still carry on."""
SPEED_UP = 13.0
"""Time in which the second walk comes to its speed, in √(L/g)."""
BESIDE = 0.1
"""Feet that are less far ahead of each other stand beside each other, in leg lengths."""

State = Literal["walk", "slow down", "jump", "walk on"]


class RunningJump:
    """Implements `hil.interface.Controller`, by the controllers of its parts.

        walk ──run-up over──▶ slow down ──feet beside each other──▶ jump ──stands──▶ walk on

    A crouch takes as long as a step or two and its feet stay where they are, so the body can carry
    on only little of its speed: the walk is told LAST_SPEED, and at the first touch-down that sets
    one foot beside the other, after two or three steps, the jump takes over. It plans with the
    velocity that is left. The jump's condition for an end, standing still, is the begin of the
    second walk, whose controller has learnt nothing yet.
    """

    def __init__(
        self,
        walk: Controller,
        jump: JumpController,
        walk_on: Controller,
        rate_hz: int,
        run_up: float,
    ) -> None:
        """`run_up`: time until the walk is slowed down [s]."""
        self._walk, self._jump, self._walk_on = walk, jump, walk_on
        self._run_up = round(run_up * rate_hz)
        robot = jump.body.robot
        self._last_speed = LAST_SPEED * (robot.gravity * robot.leg_length) ** 0.5
        self._speed_up = SPEED_UP * (robot.leg_length / robot.gravity) ** 0.5 * rate_hz
        self._ticks = 0
        self.state: State = "walk"
        self._began: int | None = None
        self._ended: int | None = None
        self.status = walk.status

    @property
    def plan(self) -> JumpPlan | None:
        """Of the jump; None before it begins."""
        return self._jump.plan

    @property
    def span(self) -> tuple[int, int | None]:
        """Ticks before the jump's first, and before the second walk's first if it has begun."""
        return self._ticks if self._began is None else self._began, self._ended

    @property
    def torque_ratio(self) -> float:
        """Largest torque that the jump asked for, as a share of its joint's limit."""
        return self._jump.torque_ratio

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The command of this tick."""
        if self.state == "walk" and self._ticks >= self._run_up:
            self.state = "slow down"
        elif self.state == "jump" and self._jump.over:
            self.state, self._ended = "walk on", self._ticks
            self.status = self._walk_on.status
        self._ticks += 1
        if self.state == "jump":
            return self._jump.step(estimate, reference)
        if self.state == "walk on":
            return self._walk_on.step(estimate, self._faster(reference))
        if self.state == "slow down":
            reference = replace(reference, speed=min(reference.speed, self._last_speed))
        steps = self._walk.status.steps
        command = self._walk.step(estimate, reference)
        touched_down = self._walk.status.steps > steps
        if self.state == "slow down" and touched_down and self._feet_beside(estimate):
            self.state, self._began = "jump", self._ticks
            self.status = self._jump.status
        return command

    def _faster(self, reference: Reference) -> Reference:
        """The second walk begins at rest and speeds up."""
        walked = self._ticks - (self._ended or 0)
        return replace(reference, speed=reference.speed * min(walked / self._speed_up, 1.0))

    def _feet_beside(self, estimate: Estimate) -> bool:
        robot = self._jump.body.robot
        robot.set_state(estimate)
        left, right = robot.ankles
        lead = float(robot.root_rotation[:, 0] @ (left - right))
        return abs(lead) < BESIDE * robot.leg_length
