// Foot board: four load cells, one ADS131M04, one frame for each conversion (docs/foot-board.md).
//
// Any 32-bit board with an Arduino core and 3.3 V pins will do; the pins below are those of a
// Raspberry Pi Pico (RP2040). The interrupt only notes the time; everything else, all of it in
// integers, happens in loop().
#include <Arduino.h>
#include <SPI.h>

#include "foot_config.h"
#include "foot_core.h"

static const uint8_t PIN_ADC_SELECT = 17;
static const uint8_t PIN_ADC_READY = 20;
static const uint8_t PIN_ADC_RESET = 21;  // SYNC/RESET, held high
static const uint8_t PIN_LED = LED_BUILTIN;

static foot_core core;
static volatile uint32_t ready_us;
static volatile bool is_ready;

static void on_ready()
{
    ready_us = micros();
    is_ready = true;
}

// One SPI frame. Byte by byte: this call is the same on every Arduino core.
static void transfer(void *, const uint8_t *out, uint8_t *in, size_t size)
{
    SPI.beginTransaction(SPISettings(FOOT_SPI_HZ, MSBFIRST, SPI_MODE1));
    digitalWrite(PIN_ADC_SELECT, LOW);
    for (size_t i = 0; i < size; i++) {
        in[i] = SPI.transfer(out[i]);
    }
    digitalWrite(PIN_ADC_SELECT, HIGH);
    SPI.endTransaction();
}

static void pause_us(void *, uint32_t microseconds)
{
    delayMicroseconds(microseconds);
}

// Until it works; the LED blinks the result: 1 no answer, 2 register lost.
static void start_adc()
{
    ads131m04_result result;
    while ((result = foot_core_start(&core)) != ADS131M04_OK) {
        for (int i = 0; i < result; i++) {
            digitalWrite(PIN_LED, HIGH);
            delay(100);
            digitalWrite(PIN_LED, LOW);
            delay(100);
        }
        delay(500);
    }
    ready_us = micros();
    is_ready = false;
}

void setup()
{
    pinMode(PIN_LED, OUTPUT);
    pinMode(PIN_ADC_SELECT, OUTPUT);
    digitalWrite(PIN_ADC_SELECT, HIGH);
    pinMode(PIN_ADC_RESET, OUTPUT);
    digitalWrite(PIN_ADC_RESET, HIGH);
    pinMode(PIN_ADC_READY, INPUT_PULLUP);
    Serial1.begin(FOOT_BAUD);
    SPI.begin();
    core.adc.transfer = transfer;
    core.adc.wait = pause_us;
    delay(10);  // supplies and clock of the ADC
    start_adc();
    attachInterrupt(digitalPinToInterrupt(PIN_ADC_READY), on_ready, FALLING);
}

void loop()
{
    noInterrupts();
    const bool due = is_ready;
    const uint32_t at_us = ready_us;
    is_ready = false;
    interrupts();

    if (due) {
        uint8_t frame[FOOT_FRAME_SIZE];
        const uint8_t valid = foot_core_sample(&core, at_us, frame);
        Serial1.write(frame, sizeof frame);
        digitalWrite(PIN_LED, valid == ADS131M04_ALL_CHANNELS ? HIGH : LOW);
    }
    if (foot_core_is_lost(&core) || micros() - at_us > FOOT_SILENCE_US) {
        start_adc();
    }
}
