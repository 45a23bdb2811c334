"""How long must a bus be silent until a servo's watchdog stops it? Found by being silent."""

from collections.abc import Callable

from drivers.commissioning.one_servo import OneServo
from drivers.dynamixel.control_table import WATCHDOG_TRIPPED, WATCHDOG_UNIT_NS, Register
from drivers.dynamixel.power import WATCHDOG_UNITS
from hil.bringup.facts import WatchdogTrip
from hil.errors import BackendError

TRIALS = 9
MOST_PERIODS = 4
"""Silence of so many nominal times that must stop it."""


def measure_watchdog(
    servo: OneServo, joint: str, effort: float, check: Callable[[], None]
) -> WatchdogTrip:
    """Bisect the silence that stops a servo at rest; its torque goes on, and stays on.

    A silence counts from the last answer to the next request, so that it is known to about one
    transfer of the adapter. `check` may raise between trials. Raises BackendError.
    """
    nominal_ns = WATCHDOG_UNITS * WATCHDOG_UNIT_NS
    quiet_ns, trip_ns = 0, MOST_PERIODS * nominal_ns
    stays = False
    servo.begin(effort, 0.0, WATCHDOG_UNITS)
    tripped, _ = _be_silent(servo, trip_ns)
    if not tripped:
        raise BackendError(
            f"{joint}: its watchdog did not stop it in {trip_ns * 1e-6:.0f} ms of silence"
        )
    for _ in range(TRIALS):
        check()
        tripped, lasted_ns = _be_silent(servo, (quiet_ns + trip_ns) // 2)
        if tripped:
            stays = bool(servo.line.client.read(servo.id, Register.TORQUE_ENABLE))
            trip_ns = min(trip_ns, lasted_ns)
        else:
            quiet_ns = max(quiet_ns, lasted_ns)
    return WatchdogTrip(joint, nominal_ns * 1e-6, quiet_ns * 1e-6, trip_ns * 1e-6, stays, TRIALS)


def _be_silent(servo: OneServo, silence_ns: int) -> tuple[bool, int]:
    """Arm the watchdog, say nothing for a while, and ask; how long it was in truth [ns]."""
    client, clock = servo.line.client, servo.line.clock
    client.write(servo.id, Register.BUS_WATCHDOG, 0)  # Forgets a trip.
    servo.go(0.0)
    client.write(servo.id, Register.BUS_WATCHDOG, WATCHDOG_UNITS)
    began_ns = clock.now_ns()
    clock.sleep_until_ns(began_ns + silence_ns)
    lasted_ns = clock.now_ns() - began_ns
    return client.read(servo.id, Register.BUS_WATCHDOG) == WATCHDOG_TRIPPED, lasted_ns
