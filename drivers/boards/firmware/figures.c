/* What follows from foot_config.h: rates, filter, delay and noise, as docs/foot-board.md shows.
 *
 * Runs on the host only (`make figures`); the firmware itself computes in integers. */
#include <math.h>
#include <stdio.h>

#include "foot_config.h"
#include "frame_encoder.h"

static const double PI = 3.14159265358979;

/* The cell and the analog side of docs/foot-board.md. */
static const double EXCITATION_V = 2.5;
static const double RATING_N = 10.0 * 9.80665;
static const double SENSITIVITY_V_PER_V = 1e-3; /* of a cheap cell; good ones have 2 mV/V */
static const double REFERENCE_V = 1.2;          /* data sheet, internal reference */
static const double ADC_NOISE_V = 0.8e-6;       /* data sheet, OSR 4096, gain 128: 0.77 uV */
static const double SERIES_OHM = 2000.0;        /* two 1 kOhm resistors, and the bridge's own */
static const double BRIDGE_OHM = 350.0;
static const double FILTER_F = 10e-9;
static const double BOLTZMANN = 1.380649e-23;
static const double KELVIN = 300.0;
/* From DRDY to the first byte on the UART: SPI, CRC, interrupt (assumed; measure it). */
static const double HANDLING_US = 50.0;

/* Mean of n samples of a sine, `step` modulator periods apart, over its amplitude. */
static double averaging(double frequency, double n, double step)
{
    const double x = PI * frequency * step / FOOT_MODULATOR_HZ;

    return fabs(x) < 1e-12 ? 1.0 : fabs(sin(n * x) / (n * sin(x)));
}

/* Gain of the digital filter at a frequency in Hz. */
static double gain(double frequency)
{
    const double sinc3 = pow(averaging(frequency, FOOT_SINC3, 1.0), 3.0);

    return sinc3 * averaging(frequency, FOOT_SINC1, FOOT_SINC3);
}

static double cut_off_hz(void)
{
    double low = 0.0, high = FOOT_MODULATOR_HZ / (double)FOOT_OSR;

    while (high - low > 0.01) {
        const double middle = 0.5 * (low + high);

        if (gain(middle) > sqrt(0.5)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Integral of gain² up to the tenth notch: the bandwidth that white noise sees. */
static double noise_bandwidth_hz(void)
{
    const double rate = FOOT_MODULATOR_HZ / (double)FOOT_OSR, step = rate / 1000.0;
    double sum = 0.0, frequency;

    for (frequency = 0.5 * step; frequency < 10.0 * rate; frequency += step) {
        sum += gain(frequency) * gain(frequency) * step;
    }
    return sum;
}

static void show(const char *name, double value, const char *format, const char *unit)
{
    printf("%-34s", name);
    printf(format, value);
    printf(" %s\n", unit);
}

static void show_timing(void)
{
    const double rate = FOOT_MODULATOR_HZ / (double)FOOT_OSR;
    const double wire_us = FOOT_FRAME_SIZE * 10.0 * 1e6 / FOOT_BAUD;
    const double filter_us = 0.5 * FOOT_DELAY_HALF_PERIODS * 1e6 / FOOT_MODULATOR_HZ;
    const double analog_us = 1e6 * (SERIES_OHM + BRIDGE_OHM) * FILTER_F;

    show("frame rate", rate, "%.1f", "Hz");
    show("half the frame rate", rate / 2, "%.1f", "Hz");
    show("filter cut-off (-3 dB)", cut_off_hz(), "%.0f", "Hz");
    show("filter at half the frame rate", 20 * log10(gain(rate / 2)), "%.1f", "dB");
    show("worst alias into 0 to 50 Hz", 20 * log10(gain(rate - 50)), "%.1f", "dB");
    show("filter at 50 Hz", 20 * log10(gain(50)), "%.2f", "dB");
    show("analog cut-off", 1e6 / (2 * PI * analog_us), "%.0f", "Hz");
    show("frame on the wire", wire_us, "%.1f", "us");
    show("wire utilisation", wire_us * rate / 1e4, "%.1f", "%");
    show("group delay of the filter", filter_us, "%.1f", "us");
    show("delay of the analog filter", analog_us, "%.1f", "us");
    show("DRDY to the first byte (assumed)", HANDLING_US, "%.0f", "us");
    show("delay_us", filter_us + analog_us + HANDLING_US, "%.0f", "us");
}

static void show_noise(void)
{
    const double full_scale_v = REFERENCE_V / (1 << FOOT_GAIN_CODE);
    const double volt_per_n = SENSITIVITY_V_PER_V * EXCITATION_V / RATING_N;
    const double resistor_v = sqrt(4 * BOLTZMANN * KELVIN * (SERIES_OHM + BRIDGE_OHM) *
                                   noise_bandwidth_hz());
    const double noise_v = sqrt(ADC_NOISE_V * ADC_NOISE_V + resistor_v * resistor_v);

    show("full scale", 1e3 * full_scale_v, "%.2f", "mV");
    show("full scale as a force", full_scale_v / volt_per_n, "%.0f", "N");
    show("cell at its rating", 1e3 * volt_per_n * RATING_N, "%.2f", "mV");
    show("one count", 1e3 * full_scale_v / 8388608.0 / volt_per_n, "%.3f", "mN");
    show("noise bandwidth", noise_bandwidth_hz(), "%.0f", "Hz");
    show("noise of ADC and resistors", 1e6 * noise_v, "%.2f", "uV");
    show("noise of one cell", noise_v / volt_per_n, "%.3f", "N");
}

int main(void)
{
    show_timing();
    show_noise();
    return 0;
}
