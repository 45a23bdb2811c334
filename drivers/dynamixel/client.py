"""One servo at a time: ping, single registers, reboot, through dynamixel-sdk. Off the hot path."""

from collections.abc import Callable
from typing import Any

from dynamixel_sdk import COMM_SUCCESS, Protocol2PacketHandler

from drivers.dynamixel.budget import BusTiming
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.port import Port
from drivers.dynamixel.protocol import ALERT, ERROR_MASK, StatusError
from drivers.dynamixel.sdk_port import SdkPort
from hil.errors import BackendError
from hil.interface import Clock

ATTEMPTS = 3
"""How often an unanswered request is sent."""


class ServoClient:
    """Blocking access to the servos of one bus.

    The alert bit is no failure: an alerting servo must stay readable, its error register above
    all. The SDK drops a byte from some stuffed answers of six data bytes and more; no register is
    that long.
    """

    def __init__(self, port: Port, timing: BusTiming, clock: Clock) -> None:
        self._name = port.name
        self._port = SdkPort(port, timing, clock)
        self._handler = Protocol2PacketHandler()

    def ping(self, servo_id: int) -> int | None:
        """Model number of a servo, None when it does not answer."""
        for _ in range(ATTEMPTS):
            number, result, _ = self._handler.ping(self._port, servo_id)
            if result == COMM_SUCCESS:
                return int(number)
        return None

    def scan(self) -> dict[int, tuple[int, int]]:
        """Model number and firmware version of every servo that answers a broadcast ping."""
        found, _ = self._handler.broadcastPing(self._port)
        return {int(key): (int(value[0]), int(value[1])) for key, value in found.items()}

    def read(self, servo_id: int, register: Register) -> int:
        """Value of a register. Raises BackendError."""
        data = self._try(
            servo_id,
            f"read {register.spec.name}",
            lambda: self._handler.readTxRx(self._port, servo_id, register.address, register.size),
        )
        if len(data) != register.size:
            raise BackendError(
                f"bus {self._name} id {servo_id}: answered {len(data)} bytes of "
                f"{register.spec.name}, {register.size} are due"
            )
        return register.spec.decode(bytes(data))

    def write(self, servo_id: int, register: Register, value: int) -> None:
        """Write a register and wait for the servo to accept it. Raises BackendError."""
        data = register.spec.encode(value)
        self._try(
            servo_id,
            f"write {value} to {register.spec.name}",
            lambda: self._handler.writeTxRx(
                self._port, servo_id, register.address, register.size, data
            ),
        )

    def reboot(self, servo_id: int) -> None:
        """Restart a servo: torque off, RAM at its defaults. Raises BackendError."""
        self._try(servo_id, "reboot", lambda: self._handler.reboot(self._port, servo_id))

    def _try(self, servo_id: int, action: str, call: Callable[[], tuple[Any, ...]]) -> Any:
        """Call the SDK until the servo answers; what it returns before result and error."""
        problem = ""
        for _ in range(ATTEMPTS):
            *value, result, error = call()
            if result != COMM_SUCCESS:
                problem = self._handler.getTxRxResult(result).removeprefix("[TxRxResult] ")
                continue
            if error & ERROR_MASK:
                problem = f"the servo refuses: {_describe(error)}"
                break
            return value[0] if value else None
        raise BackendError(f"bus {self._name} id {servo_id}: cannot {action}: {problem}")


def _describe(error: int) -> str:
    number = error & ERROR_MASK
    known = number in set(StatusError)
    name = StatusError(number).name.replace("_", " ").lower() if known else f"error {number}"
    return f"{name} (alert)" if error & ALERT else name
