"""How a robot with joint torques jumps: how low it bends, how fast it winds up, how it leans.

Bends are heights of the centre of mass below that on straight legs, in leg lengths.
"""

PUSH_DEPTH = 0.32
"""How deep it crouches for its push if nobody says, in leg lengths."""
STANDING_BEND = 0.06
TAKE_OFF_BEND = 0.16
"""A straight leg can neither push nor be drawn up; a bent one turns slower at a given speed."""
TOUCH_DOWN_BEND = 0.18
REST_BEND = 0.23
"""Where a landing comes to rest, before the body rises."""
LEAN = 0.3
"""How far the trunk leans forward in the crouch [rad]."""
WINDUP_TIME = 3.6
"""In √(L/g)."""
