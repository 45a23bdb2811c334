// A stand-in for the part of the Arduino API that foot_board.ino uses; Python drives it.
#pragma once

#include <cstddef>
#include <cstdint>

enum { LOW, HIGH };
enum { INPUT_PULLUP, OUTPUT };
enum { MSBFIRST };
enum { RISING, FALLING };
const uint8_t LED_BUILTIN = 25;

uint32_t micros();
void delay(uint32_t milliseconds);
void delayMicroseconds(uint32_t microseconds);
void pinMode(uint8_t pin, int mode);
void digitalWrite(uint8_t pin, int level);
int digitalPinToInterrupt(uint8_t pin);
void attachInterrupt(int interrupt, void (*handler)(), int mode);
void noInterrupts();
void interrupts();

struct Uart {
    void begin(unsigned long baud);
    void write(const uint8_t *data, size_t size);
};
extern Uart Serial1;
