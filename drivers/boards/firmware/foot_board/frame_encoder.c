/* Bytes of the foot frame (docs/frames.md): written one by one, so that neither the computer's
 * byte order nor its struct padding matters. */
#include "frame_encoder.h"

#include "crc16.h"

enum {
    SYNC_FIRST = 0xA5,
    SYNC_SECOND = 0x5A,
    KIND_FOOT = 0x11,         /* protocol version 1, board kind 1 */
    PAYLOAD_SIZE = 18,
    SYNC_SIZE = 2,            /* not covered by the CRC */
    CRC_OFFSET = FOOT_FRAME_SIZE - 2
};

static uint8_t *put16(uint8_t *at, uint16_t value)
{
    *at++ = (uint8_t)(value & 0xFFu);
    *at++ = (uint8_t)(value >> 8);
    return at;
}

static uint8_t *put32(uint8_t *at, uint32_t value)
{
    at = put16(at, (uint16_t)(value & 0xFFFFu));
    return put16(at, (uint16_t)(value >> 16));
}

void foot_frame_encode(uint8_t frame[FOOT_FRAME_SIZE], uint16_t sequence, uint32_t device_time_us,
                       uint16_t status, const int32_t counts[FOOT_CELLS])
{
    uint8_t *at = frame;
    uint8_t cell;

    *at++ = SYNC_FIRST;
    *at++ = SYNC_SECOND;
    *at++ = KIND_FOOT;
    *at++ = PAYLOAD_SIZE;
    at = put16(at, sequence);
    at = put32(at, device_time_us);
    at = put16(at, status);
    for (cell = 0; cell < FOOT_CELLS; cell++) {
        at = put32(at, (uint32_t)counts[cell]);
    }
    put16(at, crc16_ccitt_false(frame + SYNC_SIZE, CRC_OFFSET - SYNC_SIZE));
}
