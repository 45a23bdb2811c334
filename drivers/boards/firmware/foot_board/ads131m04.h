/* Texas Instruments ADS131M04: four 24-bit delta-sigma ADCs that sample at the same moment.
 *
 * Source of everything here: data sheet SBAS890 and its automotive twin SBASA13 (sections
 * "SPI Communication Frames", "Commands", "Registers"). The driver knows no hardware: the board
 * gives it a function that exchanges one SPI frame, and one that waits.
 *
 * An SPI frame is six words of 24 bits, most significant bit first (SPI mode 1):
 *   to the ADC:    command, register value or zero, four zeros
 *   from the ADC:  answer to the frame before, four channels, CRC
 * Commands, answers and CRC are the upper 16 bits of their words.
 */
#ifndef ADS131M04_H
#define ADS131M04_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ADS131M04_CHANNELS 4
#define ADS131M04_FRAME_SIZE 18
#define ADS131M04_ALL_CHANNELS 0x0Fu
#define ADS131M04_FULL_SCALE 8388607L
/* Largest count; the input is then the reference voltage over the gain. */

/* Exchange one frame: chip select low, `size` bytes both ways, chip select high. */
typedef void (*ads131m04_transfer)(void *context, const uint8_t *out, uint8_t *in, size_t size);
typedef void (*ads131m04_wait)(void *context, uint32_t microseconds);

struct ads131m04 {
    ads131m04_transfer transfer;
    ads131m04_wait wait;
    void *context;
    uint8_t settling;    /* samples to come before the filter has settled */
    uint8_t bad_frames;  /* frames with a wrong CRC in a row, 255 at most */
    uint8_t restarted;   /* the ADC reset itself: its registers are the factory's */
    uint8_t resynced;    /* the last STATUS told of a new synchronisation */
};

enum ads131m04_result {
    ADS131M04_OK,
    ADS131M04_NO_ANSWER,     /* a reset was not acknowledged, or a CRC was wrong */
    ADS131M04_REGISTER_LOST  /* a register did not keep what was written */
};

struct ads131m04_sample {
    uint16_t status;                     /* STATUS register */
    int32_t counts[ADS131M04_CHANNELS];  /* -8388608 .. 8388607 */
    uint8_t valid;                       /* bit i: counts[i] is a new, settled conversion */
};

/* Reset and configure; `osr_code` o is an oversampling of 128·2^o, `gain_code` g a gain of 2^g
 * on all channels (0 to 7 both). `transfer`, `wait` and `context` must be set. */
enum ads131m04_result ads131m04_init(struct ads131m04 *adc, uint8_t osr_code, uint8_t gain_code);

/* Read the conversion that DRDY announced. */
void ads131m04_read(struct ads131m04 *adc, struct ads131m04_sample *sample);

/* Read one conversion and forget it: the ADC keeps two, and after a missed DRDY the older one
 * would come first ("Collecting Data for the First Time or After a Pause"). */
void ads131m04_skip(struct ads131m04 *adc);

#ifdef __cplusplus
}
#endif

#endif
