"""Walking: one state machine, foot placement, velocity and heading; two last stages.

Torque robots end in `torque_stage`, servo robots in `servo_stage`.
"""
