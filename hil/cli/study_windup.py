"""`stride study windup`: the windup of a jump in tables and pictures."""

from typing import Annotated

from typer import Option

from hil.cli import options, study_options
from hil.cli.study_conduct import checked, conduct, resolved_request
from hil.interface import GRAVITY

AIRTIME, PUSH_DEPTH, FORWARD = 0.97, 0.35, 0.3
"""What is jumped where the command line is silent: √(L/g), leg and leg."""

Target = Annotated[
    tuple[float, float, float] | None,
    Option(metavar="X Y Z", help="Where the feet shall land in m.", show_default="0.3 leg, 0, 0"),
]
Airtime = Annotated[
    float | None, Option(help="Time in the air in s.", show_default="0.97 √(leg/g)")
]
PushDepth = Annotated[
    float | None, Option(help="How far the push lifts in m.", show_default="0.35 leg")
]
Gravity = Annotated[float, Option(help="In m/s².")]
Law = Annotated[str, Option(help="mitre (as the seed prints it) or chord (a real spring).")]


def windup(
    robot: options.Robot = "human",
    target: Target = None,
    airtime: Airtime = None,
    push_depth: PushDepth = None,
    gravity: Gravity = GRAVITY,
    law: Law = "chord",
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    scheduler: study_options.Scheduler = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """How deep a jump is wound up: constants, muscles, joint limits, other worlds; geometry."""
    from hil.robot_facts import robot_facts
    from hil.robot_files import load_robot
    from hil.studies.windup import WindupStudy
    from hil.studies.windup_case import windup_of

    request = resolved_request(robot, None, overrides)
    facts = robot_facts(load_robot(robot, request.overrides))
    study = checked(
        WindupStudy,
        request=request,
        displacement=target or (FORWARD * facts.leg_length, 0.0, 0.0),
        airtime=AIRTIME * facts.time_scale if airtime is None else airtime,
        push_depth=PUSH_DEPTH * facts.leg_length if push_depth is None else push_depth,
        gravity=gravity,
        law=law,
        few=quick,
    )
    # What cannot be wound up is refused before there is a folder; the study takes the 0.06 s again.
    windup_of(study.base)
    conduct(study, out, jobs, as_json=as_json, scheduler=scheduler)
