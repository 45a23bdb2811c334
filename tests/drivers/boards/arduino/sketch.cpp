// foot_board.ino with the stand-in Arduino: hooks for Python, and one-way state it can look at.
#include "foot_board.ino"

extern "C" {
uint32_t now_us;
uint32_t baud;
uint32_t spi_hz;
int32_t spi_mode = -1;
int32_t led = -1;
int32_t interrupts_off;
int32_t ready_pin = -1;
int32_t ready_edge = -1;
uint8_t (*on_spi)(uint8_t out);
void (*on_select)(int level);
void (*on_sent)(const uint8_t *data, size_t size);

static void (*ready_handler)();

void sketch_setup() { setup(); }
void sketch_loop() { loop(); }
void sketch_ready() { ready_handler(); }
}

Uart Serial1;
SpiBus SPI;

uint32_t micros() { return now_us; }
void delay(uint32_t milliseconds) { now_us += 1000 * milliseconds; }
void delayMicroseconds(uint32_t microseconds) { now_us += microseconds; }
void pinMode(uint8_t, int) {}
int digitalPinToInterrupt(uint8_t pin) { return pin; }
void noInterrupts() { interrupts_off++; }
void interrupts() { interrupts_off--; }

void digitalWrite(uint8_t pin, int level)
{
    if (pin == PIN_ADC_SELECT) {
        on_select(level);
    } else if (pin == PIN_LED) {
        led = level;
    }
}

void attachInterrupt(int interrupt, void (*handler)(), int mode)
{
    ready_pin = interrupt;
    ready_edge = mode;
    ready_handler = handler;
}

void Uart::begin(unsigned long speed) { baud = static_cast<uint32_t>(speed); }
void Uart::write(const uint8_t *data, size_t size) { on_sent(data, size); }

void SpiBus::beginTransaction(SPISettings settings)
{
    spi_hz = settings.hz;
    spi_mode = settings.mode;
}

uint8_t SpiBus::transfer(uint8_t out) { return on_spi(out); }
