/* From DRDY to a frame. */
#include "foot_core.h"

#include "foot_config.h"

enum { BAD_FRAMES_LIMIT = 10 };

enum ads131m04_result foot_core_start(struct foot_core *core)
{
    cell_check_start(&core->check);
    core->has_sample = 0;
    return ads131m04_init(&core->adc, FOOT_OSR_CODE, FOOT_GAIN_CODE);
}

uint8_t foot_core_sample(struct foot_core *core, uint32_t drdy_us,
                         uint8_t frame[FOOT_FRAME_SIZE])
{
    struct ads131m04_sample sample;
    uint8_t status;

    /* Unsigned, so the difference is right across the wrap of the clock. */
    if (core->has_sample && drdy_us - core->last_drdy_us > FOOT_PERIOD_US * 3 / 2) {
        ads131m04_skip(&core->adc);
    }
    core->last_drdy_us = drdy_us;
    core->has_sample = 1;
    ads131m04_read(&core->adc, &sample);
    status = cell_check_update(&core->check, sample.counts, sample.valid);
    foot_frame_encode(frame, core->sequence++, drdy_us - (uint32_t)FOOT_GROUP_DELAY_US,
                      status, sample.counts);
    return status;
}

uint8_t foot_core_is_lost(const struct foot_core *core)
{
    return core->adc.restarted || core->adc.bad_frames >= BAD_FRAMES_LIMIT;
}
