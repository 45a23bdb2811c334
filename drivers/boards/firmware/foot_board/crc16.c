/* CRC-16/CCITT-FALSE, bit by bit: 28 bytes a frame do not need a table. */
#include "crc16.h"

uint16_t crc16_ccitt_false(const uint8_t *data, size_t size)
{
    uint16_t crc = 0xFFFFu;

    while (size-- > 0) {
        uint8_t bit;

        crc ^= (uint16_t)((uint16_t)*data++ << 8);
        for (bit = 0; bit < 8; bit++) {
            if (crc & 0x8000u) {
                crc = (uint16_t)((uint16_t)(crc << 1) ^ 0x1021u);
            } else {
                crc = (uint16_t)(crc << 1);
            }
        }
    }
    return crc;
}
