/* The foot frame of docs/frames.md, byte for byte, on any computer that has C99. */
#ifndef FRAME_ENCODER_H
#define FRAME_ENCODER_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FOOT_CELLS 4
/* Cells in the order of the frame: front left, front right, rear left, rear right. */

#define FOOT_FRAME_SIZE 30

/* Write one frame.
 *
 * sequence:        counts up by one each frame and wraps
 * device_time_us:  the board's clock when the sample was taken, wraps
 * status:          bit i set: counts[i] is valid
 * counts:          raw counts of the cells
 */
void foot_frame_encode(uint8_t frame[FOOT_FRAME_SIZE], uint16_t sequence, uint32_t device_time_us,
                       uint16_t status, const int32_t counts[FOOT_CELLS]);

#ifdef __cplusplus
}
#endif

#endif
