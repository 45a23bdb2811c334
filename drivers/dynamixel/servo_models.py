"""Dynamixel models as data: constants, limits and factory values. A new model is a new row.

Sources: ROBOTIS e-manual (specification and control table page of each model). Stall and no-load
figures are those at `voltage`.
"""

from dataclasses import dataclass

from drivers.dynamixel.control_table import BAUD_CODES, HardwareError, OperatingMode, Register
from hil.errors import InputError, UnknownNameError

_RPM = 0.104719755
_SHUTDOWN_52 = HardwareError.OVERHEATING | HardwareError.ELECTRICAL_SHOCK | HardwareError.OVERLOAD
_SHUTDOWN_53 = _SHUTDOWN_52 | HardwareError.INPUT_VOLTAGE
_ALL_BAUDS = tuple(BAUD_CODES)
_BAUDS_TO_4M = tuple(baud for baud in BAUD_CODES if baud <= 4_000_000)
_SIX_MODES = tuple(OperatingMode)
_NO_CURRENT_MODES = (
    OperatingMode.VELOCITY,
    OperatingMode.POSITION,
    OperatingMode.EXTENDED_POSITION,
    OperatingMode.PWM,
)


@dataclass(frozen=True, slots=True)
class IndirectCells:
    """One run of indirect cells: 2-byte addresses and the data bytes that they point at."""

    address: int
    data: int
    count: int


_CELLS_56 = (IndirectCells(168, 224, 28), IndirectCells(578, 634, 28))
_CELLS_20 = (IndirectCells(168, 208, 20),)


@dataclass(frozen=True, slots=True)
class ServoModel:
    """One Dynamixel model.

    The motor constant follows from the two ends of the torque-speed line at V: the back-EMF
    constant is K = V/ω₀ and the resistance R = K·V/τ₀, so that the model stalls at τ₀ and idles
    at ω₀. (k_t = τ₀/I_stall, from the datasheet's current, is up to 40 % lower: it counts
    gearbox losses. Measured current is turned into torque with K as well, for consistency.)
    """

    name: str
    number: int
    voltage: float
    """Voltage at which the figures below hold [V]."""
    stall_torque: float
    """[N·m]"""
    stall_current: float
    """[A]"""
    no_load_speed: float
    """[rad/s]"""
    gear_ratio: float
    position_gains: tuple[int, int, int]
    """Factory P, I and D gain of position control."""
    velocity_gains: tuple[int, int]
    """Factory P and I gain of velocity control."""
    current_unit: float | None
    """[A] of one current count; None for a model that measures load in 0.1 %."""
    current_limit: int | None
    """Factory and largest Current Limit [counts]."""
    velocity_limit: int
    """Factory Velocity Limit [0.229 rev/min]."""
    voltage_limits: tuple[int, int]
    """Factory minimum and maximum input voltage, also their range [0.1 V]."""
    temperature_limit: int
    """Factory Temperature Limit [°C]."""
    shutdown: HardwareError
    """Factory Shutdown mask."""
    bauds: tuple[int, ...]
    """Speeds that the model supports [bit/s]."""
    modes: tuple[OperatingMode, ...]
    indirect: tuple[IndirectCells, ...]
    gain_divisor: int = 128
    """Position P Gain register units per internal unit."""
    fast_read_firmware: int | None = 45
    """First firmware with fast sync and bulk read; None for never (2XL, 2XC)."""
    pwm_slope: int | None = None
    """Factory PWM Slope; None for a model without that register."""

    @property
    def torque_constant(self) -> float:
        """K = V/ω₀ [N·m/A = V·s/rad]."""
        return self.voltage / self.no_load_speed

    @property
    def resistance(self) -> float:
        """R = K·V/τ₀ [Ω]."""
        return self.torque_constant * self.voltage / self.stall_torque

    @property
    def back_emf_damping(self) -> float:
        """K²/R = τ₀/ω₀ [N·m·s/rad]."""
        return self.stall_torque / self.no_load_speed

    def initial(self, register: Register) -> int | None:
        """Factory value of a register; None for a measurement or a model without it."""
        p, i, d = self.position_gains
        velocity_p, velocity_i = self.velocity_gains
        special = {
            Register.MODEL_NUMBER: self.number,
            Register.TEMPERATURE_LIMIT: self.temperature_limit,
            Register.MIN_VOLTAGE_LIMIT: self.voltage_limits[0],
            Register.MAX_VOLTAGE_LIMIT: self.voltage_limits[1],
            Register.CURRENT_LIMIT: self.current_limit,
            Register.VELOCITY_LIMIT: self.velocity_limit,
            Register.PWM_SLOPE: self.pwm_slope,
            Register.SHUTDOWN: int(self.shutdown),
            Register.POSITION_P_GAIN: p,
            Register.POSITION_I_GAIN: i,
            Register.POSITION_D_GAIN: d,
            Register.VELOCITY_P_GAIN: velocity_p,
            Register.VELOCITY_I_GAIN: velocity_i,
            Register.GOAL_PWM: Register.PWM_LIMIT.spec.initial,
            Register.GOAL_CURRENT: self.current_limit,
        }
        return special.get(register, register.spec.initial)


_ROWS = (
    ServoModel(
        name="XM430-W350", number=1020, voltage=12.0, stall_torque=4.1, stall_current=2.3,
        no_load_speed=46 * _RPM, gear_ratio=353.5, position_gains=(800, 0, 0),
        velocity_gains=(100, 1920), current_unit=2.69e-3, current_limit=1193, velocity_limit=200,
        voltage_limits=(95, 160), temperature_limit=80, shutdown=_SHUTDOWN_52, bauds=_ALL_BAUDS,
        modes=_SIX_MODES, indirect=_CELLS_56,
    ),
    ServoModel(
        name="XM430-W210", number=1030, voltage=12.0, stall_torque=3.0, stall_current=2.3,
        no_load_speed=77 * _RPM, gear_ratio=212.6, position_gains=(800, 0, 0),
        velocity_gains=(100, 1920), current_unit=2.69e-3, current_limit=1193, velocity_limit=330,
        voltage_limits=(95, 160), temperature_limit=80, shutdown=_SHUTDOWN_52, bauds=_ALL_BAUDS,
        modes=_SIX_MODES, indirect=_CELLS_56,
    ),
    ServoModel(
        name="XL430-W250", number=1060, voltage=11.1, stall_torque=1.4, stall_current=1.3,
        no_load_speed=57 * _RPM, gear_ratio=258.5, position_gains=(640, 0, 4000),
        velocity_gains=(100, 1000), current_unit=None, current_limit=None, velocity_limit=265,
        voltage_limits=(60, 140), temperature_limit=72, shutdown=_SHUTDOWN_52, bauds=_ALL_BAUDS,
        modes=_NO_CURRENT_MODES, indirect=_CELLS_56,
    ),
    ServoModel(
        name="XH540-W270", number=1100, voltage=12.0, stall_torque=9.9, stall_current=4.9,
        no_load_speed=39 * _RPM, gear_ratio=272.5, position_gains=(800, 0, 0),
        velocity_gains=(100, 1920), current_unit=2.69e-3, current_limit=2047, velocity_limit=167,
        voltage_limits=(95, 160), temperature_limit=80, shutdown=_SHUTDOWN_52, bauds=_ALL_BAUDS,
        modes=_SIX_MODES, indirect=_CELLS_56,
    ),
    ServoModel(
        name="XL330-M288", number=1200, voltage=5.0, stall_torque=0.52, stall_current=1.47,
        no_load_speed=103 * _RPM, gear_ratio=288.4, position_gains=(400, 0, 0),
        velocity_gains=(180, 1600), current_unit=1e-3, current_limit=1750, velocity_limit=445,
        voltage_limits=(35, 70), temperature_limit=70, shutdown=_SHUTDOWN_53, bauds=_BAUDS_TO_4M,
        modes=_SIX_MODES, indirect=_CELLS_20, gain_divisor=256, fast_read_firmware=46,
        pwm_slope=140,
    ),
    ServoModel(
        name="XC330-T288", number=1220, voltage=11.1, stall_torque=0.92, stall_current=0.80,
        no_load_speed=65 * _RPM, gear_ratio=288.4, position_gains=(900, 0, 0),
        velocity_gains=(40, 1200), current_unit=1e-3, current_limit=910, velocity_limit=320,
        voltage_limits=(55, 140), temperature_limit=70, shutdown=_SHUTDOWN_52, bauds=_BAUDS_TO_4M,
        modes=_SIX_MODES, indirect=_CELLS_20, fast_read_firmware=46, pwm_slope=255,
    ),
)  # fmt: skip

SERVO_MODELS = {model.name: model for model in _ROWS}


def find_servo_model(name: str) -> ServoModel:
    """The model of a name. Raises UnknownNameError."""
    if name not in SERVO_MODELS:
        raise UnknownNameError("servo model", name, SERVO_MODELS)
    return SERVO_MODELS[name]


def find_servo_model_by_number(number: int) -> ServoModel:
    """The model of a Model Number (0). Raises InputError."""
    for model in _ROWS:
        if model.number == number:
            return model
    known = ", ".join(f"{model.number} {model.name}" for model in _ROWS)
    raise InputError(f"unknown servo model number {number}; valid: {known}")
