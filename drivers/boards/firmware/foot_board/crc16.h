/* CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF, not reflected, not inverted.
 *
 * Our frames use it (docs/frames.md), and so does the ADC on its SPI frames (ADS131M04 data
 * sheet SBAS890, "Communication Cyclic Redundancy Check": CCITT type, seed FFFFh).
 * Check value of "123456789": 0x29B1.
 */
#ifndef CRC16_H
#define CRC16_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

uint16_t crc16_ccitt_false(const uint8_t *data, size_t size);

#ifdef __cplusplus
}
#endif

#endif
