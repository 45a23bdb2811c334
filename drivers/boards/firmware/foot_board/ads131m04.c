/* ADS131M04 over an abstract SPI frame (data sheet SBAS890). */
#include "ads131m04.h"

#include "crc16.h"

enum { WORD_SIZE = 3, CRC_AT = 15 };
enum { RESET_WAIT_US = 10 /* tREGACQ is 5 */, SETTLING_SAMPLES = 3 };

/* Commands ("Commands" table); the address sits at bit 7 of the register commands. */
#define CMD_NULL 0x0000u
#define CMD_RESET 0x0011u
#define CMD_RREG 0xA000u
#define CMD_WREG 0x6000u
#define RESET_DONE 0xFF24u
/* Answer to RESET: FF20h plus the number of channels. */

/* Registers ("Register Map"). */
enum { REG_MODE = 0x02, REG_CLOCK = 0x03, REG_GAIN1 = 0x04 };

/* STATUS: the ADC was reset; it was synchronised anew; word length (01b: 24 bits). The lowest
 * four bits tell which channels have a conversion that was not read yet. */
enum { STATUS_RESET = 0x0400, STATUS_RESYNC = 0x4000, STATUS_WORD = 0x0300, WORD_24 = 0x0100 };

/* MODE: 24-bit words, SPI time-out on, CRC of CCITT type, DRDY low until read, and the RESET
 * flag cleared, so that it tells of a reset that nobody asked for. */
enum { MODE_VALUE = 0x0110 };

/* CLOCK: four channels on, high-resolution power mode; the oversampling is at bit 2. */
enum { CLOCK_VALUE = 0x0F02, CLOCK_OSR_SHIFT = 2 };

static uint16_t word_at(const uint8_t *frame, uint8_t index)
{
    const uint8_t *word = frame + WORD_SIZE * index;

    return (uint16_t)((uint16_t)((uint16_t)word[0] << 8) | word[1]);
}

/* A 24-bit two's complement word; no shift of a negative number, which C99 leaves open. */
static int32_t count_at(const uint8_t *frame, uint8_t index)
{
    const uint8_t *word = frame + WORD_SIZE * index;
    int32_t value = (int32_t)(((uint32_t)word[0] << 16) | ((uint32_t)word[1] << 8) | word[2]);

    return value > ADS131M04_FULL_SCALE ? value - 2 * (ADS131M04_FULL_SCALE + 1) : value;
}

/* Exchange one frame; whether what came back has the right CRC. */
static uint8_t exchange(struct ads131m04 *adc, uint16_t command, uint16_t value, uint8_t *in)
{
    uint8_t out[ADS131M04_FRAME_SIZE] = {0};

    out[0] = (uint8_t)(command >> 8);
    out[1] = (uint8_t)(command & 0xFFu);
    out[WORD_SIZE] = (uint8_t)(value >> 8);
    out[WORD_SIZE + 1] = (uint8_t)(value & 0xFFu);
    adc->transfer(adc->context, out, in, ADS131M04_FRAME_SIZE);
    return crc16_ccitt_false(in, CRC_AT) == word_at(in, CRC_AT / WORD_SIZE);
}

/* Write a register and read it back. */
static enum ads131m04_result write_register(struct ads131m04 *adc, uint8_t address, uint16_t value)
{
    uint8_t in[ADS131M04_FRAME_SIZE];

    exchange(adc, (uint16_t)(CMD_WREG | (address << 7)), value, in);
    exchange(adc, (uint16_t)(CMD_RREG | (address << 7)), 0, in);
    if (!exchange(adc, CMD_NULL, 0, in)) {
        return ADS131M04_NO_ANSWER;
    }
    return word_at(in, 0) == value ? ADS131M04_OK : ADS131M04_REGISTER_LOST;
}

/* Another chip of the family fails here: the answer and the place of the CRC tell the channels. */
static enum ads131m04_result reset(struct ads131m04 *adc)
{
    uint8_t in[ADS131M04_FRAME_SIZE];

    exchange(adc, CMD_RESET, 0, in);
    adc->wait(adc->context, RESET_WAIT_US);
    if (!exchange(adc, CMD_NULL, 0, in) || word_at(in, 0) != RESET_DONE) {
        return ADS131M04_NO_ANSWER;
    }
    return ADS131M04_OK;
}

enum ads131m04_result ads131m04_init(struct ads131m04 *adc, uint8_t osr_code, uint8_t gain_code)
{
    enum ads131m04_result result = reset(adc);

    if (result == ADS131M04_OK) {
        result = write_register(adc, REG_MODE, MODE_VALUE);
    }
    if (result == ADS131M04_OK) {
        result = write_register(adc, REG_CLOCK,
                                (uint16_t)(CLOCK_VALUE | (osr_code << CLOCK_OSR_SHIFT)));
    }
    if (result == ADS131M04_OK) {
        result = write_register(adc, REG_GAIN1, (uint16_t)(gain_code * 0x1111u));
    }
    ads131m04_skip(adc);
    ads131m04_skip(adc);
    adc->settling = SETTLING_SAMPLES;
    adc->bad_frames = 0;
    adc->restarted = 0;
    adc->resynced = 0;
    return result;
}

void ads131m04_read(struct ads131m04 *adc, struct ads131m04_sample *sample)
{
    uint8_t in[ADS131M04_FRAME_SIZE];
    uint8_t channel, resynced;
    uint8_t intact = exchange(adc, CMD_NULL, 0, in);

    sample->status = word_at(in, 0);
    for (channel = 0; channel < ADS131M04_CHANNELS; channel++) {
        sample->counts[channel] = count_at(in, (uint8_t)(channel + 1));
    }
    sample->valid = 0;
    if (!intact || (sample->status & STATUS_WORD) != WORD_24) {
        adc->bad_frames = (uint8_t)(adc->bad_frames + (adc->bad_frames < 255));
        return;
    }
    adc->bad_frames = 0;
    /* Only its coming counts: how long the flag stays is not relied on. */
    resynced = (sample->status & STATUS_RESYNC) != 0;
    if (resynced && !adc->resynced) {
        adc->settling = SETTLING_SAMPLES;
    }
    adc->resynced = resynced;
    if (sample->status & STATUS_RESET) {
        adc->restarted = 1;
    } else if (adc->settling > 0) {
        adc->settling--;
    } else {
        sample->valid = (uint8_t)(sample->status & ADS131M04_ALL_CHANNELS);
    }
}

void ads131m04_skip(struct ads131m04 *adc)
{
    uint8_t in[ADS131M04_FRAME_SIZE];

    exchange(adc, CMD_NULL, 0, in);
}
