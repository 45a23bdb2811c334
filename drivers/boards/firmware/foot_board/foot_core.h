/* The foot board without its hardware: from DRDY to the bytes of a frame. */
#ifndef FOOT_CORE_H
#define FOOT_CORE_H

#include "ads131m04.h"
#include "cell_check.h"
#include "frame_encoder.h"

#ifdef __cplusplus
extern "C" {
#endif

struct foot_core {
    struct ads131m04 adc;
    struct cell_check check;
    uint16_t sequence;
    uint32_t last_drdy_us;
    uint8_t has_sample;
};

/* Start or restart the ADC and forget what was known of the cells. The sequence goes on, so that
 * the host sees a restart as lost time, not as a new board. */
enum ads131m04_result foot_core_start(struct foot_core *core);

/* Answer a DRDY that came at `drdy_us`: read the ADC, judge the cells, make the frame. Its device
 * time is that of the sample, the group delay of the filter before DRDY. Returns the cells that
 * are valid. */
uint8_t foot_core_sample(struct foot_core *core, uint32_t drdy_us,
                         uint8_t frame[FOOT_FRAME_SIZE]);

/* Whether the ADC lost its registers or speaks nonsense: foot_core_start is due. */
uint8_t foot_core_is_lost(const struct foot_core *core);

#ifdef __cplusplus
}
#endif

#endif
