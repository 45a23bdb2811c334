"""Any Dynamixel client can talk to the virtual robot: here the vendor's SDK pings a leg."""

import json
import subprocess
import sys

from dynamixel_sdk import COMM_SUCCESS, PacketHandler, PortHandler

PRESENT_POSITION = 132
BAUD = 4_000_000

server = subprocess.Popen(
    [sys.executable, "-c", "from hil.cli.main import main; main()", "emulate", "--json"],
    stdin=subprocess.PIPE,
    stdout=subprocess.PIPE,
    text=True,
)
try:
    ports = json.loads(server.stdout.readline())
    port = PortHandler(ports["buses"]["left_leg"])
    packets = PacketHandler(2.0)
    port.openPort()
    port.setBaudRate(BAUD)
    for servo_id in range(1, 7):
        model, result, _ = packets.ping(port, servo_id)
        position, _, _ = packets.read4ByteTxRx(port, servo_id, PRESENT_POSITION)
        answer = "answers" if result == COMM_SUCCESS else "is silent"
        print(f"servo {servo_id} {answer}: model {model}, position {position}")
    port.closePort()
finally:
    server.terminate()
    server.wait()
