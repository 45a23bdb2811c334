"""One Dynamixel model as validated data: what its registers hold and what its motor can do."""

from functools import cached_property
from typing import Literal, NamedTuple, Self

from pydantic import Field, PositiveFloat, PositiveInt, model_validator

from drivers.dynamixel.control_table import BAUD_CODES, RPM, OperatingMode, Register
from hil.validation import Config


class IndirectCells(Config):
    """One run of indirect cells: 2-byte addresses and the data bytes that they point at."""

    address: int
    data: int
    count: int


class IndirectLayout(Config):
    """Where indirect cells are, from a firmware on."""

    firmware: int
    cells: tuple[IndirectCells, ...]


class OperatingPoint(Config):
    """Both ends of the torque-speed line at one voltage, as the data sheet has them."""

    voltage: PositiveFloat
    """[V]"""
    torque: PositiveFloat
    """At standstill [N·m]."""
    current: PositiveFloat
    """At standstill [A]."""
    speed: PositiveFloat
    """Without load [rev/min]."""

    @property
    def omega(self) -> float:
        """Speed without load [rad/s]."""
        return self.speed * RPM


class PublishedConstants(Config):
    """What somebody else found for the motor."""

    torque_constant: PositiveFloat
    """[N·m/A]"""
    resistance: PositiveFloat | None = None
    """[Ω]"""
    source: str


class Range(NamedTuple):
    """Least and greatest of the values that the data support."""

    low: float
    high: float


class ServoModel(Config):
    """One Dynamixel model.

    The motor constant follows from the two ends of the torque-speed line at V: the back-EMF
    constant is K = V/ω₀ and the resistance R = K·V/τ₀, so that the model stalls at τ₀ and idles
    at ω₀. (k_t = τ₀/I_stall, from the datasheet's current, is up to 40 % lower: it counts
    gearbox losses. Measured current is turned into torque with K as well, for consistency.)
    How far other ways of deriving a constant lead is what `*_range` says.
    """

    name: str
    number: int
    axes: Literal[1, 2]
    """Output shafts; each has its own id."""
    resolution: Literal[4096]
    """Positions a turn; the driver knows no other."""
    voltage: PositiveFloat
    """Recommended voltage, at which the figures below hold [V]."""
    input_voltage: tuple[float, float]
    """Voltages that the data sheet allows [V]."""
    datasheet: tuple[OperatingPoint, ...] = Field(min_length=1)
    gear_ratio: PositiveFloat
    position_gains: tuple[int, int, int]
    """Factory P, I and D gain of position control."""
    velocity_gains: tuple[int, int]
    """Factory P and I gain of velocity control."""
    current_unit: float | None
    """[A] of one current count; None for a model that measures load in 0.1 %."""
    current_limit: int | None
    """Factory and largest Current Limit [counts]."""
    current_sensing: Literal["motor", "supply"]
    """Where current is measured: a supply's current is the motor's times the duty."""
    velocity_limit: int
    """Factory Velocity Limit [0.229 rev/min]."""
    voltage_limits: tuple[int, int]
    """Factory minimum and maximum input voltage, also their range [0.1 V]."""
    temperature_limit: int
    """Factory Temperature Limit [°C]."""
    shutdown: int
    """Factory Shutdown mask."""
    highest_baud: int
    """[bit/s]"""
    modes: tuple[OperatingMode, ...]
    layouts: tuple[IndirectLayout, ...] = Field(min_length=1, alias="indirect")
    """Indirect cells by firmware, oldest first."""
    gain_divisor: PositiveInt
    """Position P Gain register units per internal unit."""
    current_divisor: PositiveInt | None
    """Position P Gain register units per current count and position count, in mode 5."""
    fast_read_firmware: int | None
    """First firmware with fast sync and bulk read; None for never."""
    watchdog_firmware: int
    """First firmware with the bus watchdog."""
    startup_firmware: int | None
    """First firmware with Startup Configuration and Backup Ready; None for never."""
    pwm_slope: int | None
    """Factory PWM Slope; None for a model without that register."""
    pwm_slope_unit: float | None
    """[V/s] of one count of PWM Slope."""
    published: tuple[PublishedConstants, ...] = ()
    factory: dict[str, int] = {}
    """Factory values that differ from the common table, by name in `Register`."""
    sources: dict[str, str]
    """Where each value is from, by key: a document, or "assumed" and why."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if not any(point.voltage == self.voltage for point in self.datasheet):
            raise ValueError(f"datasheet has no point at the recommended {self.voltage:g} V")
        current = (self.current_unit, self.current_limit, self.current_divisor)
        if len({value is None for value in current}) > 1:
            raise ValueError("current_unit, current_limit and current_divisor belong together")
        if self.highest_baud not in BAUD_CODES:
            raise ValueError(f"highest_baud must be one of {', '.join(map(str, BAUD_CODES))}")
        return self

    # Motor -----------------------------------------------------------------------------------

    @cached_property
    def rated(self) -> OperatingPoint:
        """The data sheet at the recommended voltage."""
        return next(point for point in self.datasheet if point.voltage == self.voltage)

    @property
    def stall_torque(self) -> float:
        """At `voltage` [N·m]."""
        return self.rated.torque

    @property
    def stall_current(self) -> float:
        """At `voltage` [A]."""
        return self.rated.current

    @property
    def no_load_speed(self) -> float:
        """At `voltage` [rad/s]."""
        return self.rated.omega

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

    @cached_property
    def torque_constant_range(self) -> Range:
        """V/ω₀ and τ₀/I at every voltage of the data sheet, and what is published [N·m/A]."""
        values = [point.voltage / point.omega for point in self.datasheet]
        values += [point.torque / point.current for point in self.datasheet]
        values += [found.torque_constant for found in self.published]
        return Range(min(values), max(values))

    @cached_property
    def resistance_range(self) -> Range:
        """V/I and K·V/τ₀ at every voltage, and what is published [Ω]."""
        values = [point.voltage / point.current for point in self.datasheet]
        values += [point.voltage**2 / (point.omega * point.torque) for point in self.datasheet]
        values += [found.resistance for found in self.published if found.resistance is not None]
        return Range(min(values), max(values))

    @cached_property
    def torque_per_volt_range(self) -> Range:
        """τ₀/V at every voltage, and what is published [N·m/V]: the uncertainty of stiffness."""
        values = [point.torque / point.voltage for point in self.datasheet]
        values += [
            found.torque_constant / found.resistance
            for found in self.published
            if found.resistance is not None
        ]
        return Range(min(values), max(values))

    @cached_property
    def damping_range(self) -> Range:
        """τ₀/ω₀ and τ₀²/(V·I) at every voltage, and what is published [N·m·s/rad]."""
        values = [point.torque / point.omega for point in self.datasheet]
        values += [point.torque**2 / (point.voltage * point.current) for point in self.datasheet]
        values += [
            found.torque_constant**2 / found.resistance
            for found in self.published
            if found.resistance is not None
        ]
        return Range(min(values), max(values))

    # Control table ---------------------------------------------------------------------------

    @cached_property
    def bauds(self) -> tuple[int, ...]:
        """Speeds that the model supports [bit/s]."""
        return tuple(baud for baud in BAUD_CODES if baud <= self.highest_baud)

    @cached_property
    def registers(self) -> frozenset[Register]:
        """Registers that the model has, whatever its firmware."""
        missing: set[Register] = set()
        if self.current_limit is None:
            missing |= {Register.CURRENT_LIMIT, Register.GOAL_CURRENT}
        if self.pwm_slope is None:
            missing.add(Register.PWM_SLOPE)
        if self.startup_firmware is None:
            missing |= {Register.STARTUP_CONFIGURATION, Register.BACKUP_READY}
        return frozenset(Register) - missing

    @property
    def indirect(self) -> tuple[IndirectCells, ...]:
        """Indirect cells of the latest firmware."""
        return self.layouts[-1].cells

    def indirect_for(self, firmware: int) -> tuple[IndirectCells, ...]:
        """Indirect cells of a firmware, as read back from Firmware Version (6)."""
        return [layout for layout in self.layouts if layout.firmware <= firmware][-1].cells

    def supports_fast_read(self, firmware: int) -> bool:
        """Whether a firmware answers fast sync and bulk reads."""
        return self.fast_read_firmware is not None and firmware >= self.fast_read_firmware

    def initial(self, register: Register) -> int | None:
        """Factory value of a register; None for a measurement or a model without it."""
        if register not in self.registers:
            return None
        if register in self._factory_values:
            return self._factory_values[register]
        return register.spec.initial

    @cached_property
    def _factory_values(self) -> dict[Register, int | None]:
        p, i, d = self.position_gains
        velocity_p, velocity_i = self.velocity_gains
        values: dict[Register, int | None] = {
            Register.MODEL_NUMBER: self.number,
            Register.TEMPERATURE_LIMIT: self.temperature_limit,
            Register.MIN_VOLTAGE_LIMIT: self.voltage_limits[0],
            Register.MAX_VOLTAGE_LIMIT: self.voltage_limits[1],
            Register.CURRENT_LIMIT: self.current_limit,
            Register.VELOCITY_LIMIT: self.velocity_limit,
            Register.PWM_SLOPE: self.pwm_slope,
            Register.SHUTDOWN: self.shutdown,
            Register.POSITION_P_GAIN: p,
            Register.POSITION_I_GAIN: i,
            Register.POSITION_D_GAIN: d,
            Register.VELOCITY_P_GAIN: velocity_p,
            Register.VELOCITY_I_GAIN: velocity_i,
            Register.GOAL_PWM: Register.PWM_LIMIT.spec.initial,
            Register.GOAL_CURRENT: self.current_limit,
        }
        return values | {Register[name]: value for name, value in self.factory.items()}
