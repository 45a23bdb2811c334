/* What a builder may change, and the times that follow from it (docs/foot-board.md). */
#ifndef FOOT_CONFIG_H
#define FOOT_CONFIG_H

#define FOOT_CLKIN_HZ 8192000UL
/* Clock of the ADC. 8.192 MHz: 1000 frames a second; 4.9152 MHz: 600. */
#define FOOT_OSR_CODE 5
/* Oversampling 128·2^5 = 4096. */
#define FOOT_GAIN_CODE 6
/* Gain 2^6 = 64: full scale 18.75 mV, 2.5 times a 3 mV/V cell at 2.5 V. */

#define FOOT_OSR (128UL << FOOT_OSR_CODE)
#define FOOT_MODULATOR_HZ (FOOT_CLKIN_HZ / 2UL)
#define FOOT_PERIOD_US (1000000UL * FOOT_OSR / FOOT_MODULATOR_HZ)

/* The digital filter is a sinc3 over at most 1024 modulator samples and a sinc1 over its outputs
 * (data sheet, "SINC3 and SINC3 + SINC1 Filter"). Both are symmetric, so their delay is half
 * their length: 3·(N − 1)/2 modulator periods and (M − 1)/2 outputs of N periods each. */
#define FOOT_SINC3 (FOOT_OSR < 1024UL ? FOOT_OSR : 1024UL)
#define FOOT_SINC1 (FOOT_OSR / FOOT_SINC3)
#define FOOT_DELAY_HALF_PERIODS (3UL * (FOOT_SINC3 - 1UL) + (FOOT_SINC1 - 1UL) * FOOT_SINC3)
#define FOOT_GROUP_DELAY_US \
    ((FOOT_DELAY_HALF_PERIODS * 1000UL + FOOT_CLKIN_HZ / 2000UL) / (FOOT_CLKIN_HZ / 1000UL))

#define FOOT_BAUD 921600
#define FOOT_SPI_HZ 8000000
#define FOOT_SILENCE_US 100000UL
/* Without DRDY for so long the ADC is started again. */

#endif
