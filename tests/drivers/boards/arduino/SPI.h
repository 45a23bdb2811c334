// A stand-in for the Arduino SPI library.
#pragma once

#include <cstdint>

enum { SPI_MODE0, SPI_MODE1, SPI_MODE2, SPI_MODE3 };

struct SPISettings {
    SPISettings(uint32_t hz, int order, int mode) : hz(hz), order(order), mode(mode) {}
    uint32_t hz;
    int order, mode;
};

struct SpiBus {
    void begin() {}
    void beginTransaction(SPISettings settings);
    void endTransaction() {}
    uint8_t transfer(uint8_t out);
};
extern SpiBus SPI;
