/* Reduced foot board for an ATmega328P at 16 MHz: frames and cell check, but no ADC.
 *
 * Its counts are made up (below), so that the bytes a microcontroller really puts on a UART can
 * be checked without hardware: in Debian's simavr, on a pty (simavr_pty.c), or on an Arduino Uno.
 * 200 frames a second at 500 000 baud, which 16 MHz divides without error (ATmega328P data sheet,
 * table of baud rates: UBRR 3 with U2X).
 */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <stdint.h>

#include "cell_check.h"
#include "frame_encoder.h"

#define PERIOD_US 5000UL
#define UBRR_500K 3
#define TIMER_TOP (F_CPU / 8UL / (1000000UL / PERIOD_US) - 1UL)
#define FULL_SCALE 8388607L

static volatile uint32_t sample_us;
static volatile uint8_t is_due;

ISR(TIMER1_COMPA_vect)
{
    sample_us += PERIOD_US;
    is_due = 1;
}

static void start_hardware(void)
{
    UBRR0 = UBRR_500K;
    UCSR0A = _BV(U2X0);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00); /* 8N1 */
    UCSR0B = _BV(TXEN0);
    OCR1A = TIMER_TOP;
    TCCR1B = _BV(WGM12) | _BV(CS11);    /* clear on match, 2 MHz */
    TIMSK1 = _BV(OCIE1A);
    set_sleep_mode(SLEEP_MODE_IDLE);
}

/* Sleep until the next sample; its time. */
static uint32_t wait_for_sample(void)
{
    uint32_t at_us;

    cli();
    while (!is_due) {
        sleep_enable();
        sei(); /* takes effect after the next instruction: no interrupt slips in between */
        sleep_cpu();
        sleep_disable();
        cli();
    }
    is_due = 0;
    at_us = sample_us;
    sei();
    return at_us;
}

/* Saw teeth of different speeds; the last cell is open for 64 of 128 frames. */
static void make_counts(uint16_t sequence, int32_t counts[FOOT_CELLS])
{
    static const uint32_t steps[FOOT_CELLS] = {1237, 4099, 20011, 65537};
    uint8_t cell;

    for (cell = 0; cell < FOOT_CELLS; cell++) {
        counts[cell] = (int32_t)(sequence * steps[cell] & 0x3FFFFFUL) - 0x200000L;
    }
    if (sequence & 64u) {
        counts[FOOT_CELLS - 1] = FULL_SCALE;
    }
}

int main(void)
{
    struct cell_check check;
    uint8_t frame[FOOT_FRAME_SIZE];
    int32_t counts[FOOT_CELLS];
    uint16_t sequence = 0;

    start_hardware();
    cell_check_start(&check);
    for (;;) {
        uint32_t at_us = wait_for_sample();
        uint8_t status;
        uint8_t i;

        make_counts(sequence, counts);
        status = cell_check_update(&check, counts, 0x0F);
        foot_frame_encode(frame, sequence++, at_us, status, counts);
        for (i = 0; i < FOOT_FRAME_SIZE; i++) {
            while (!(UCSR0A & _BV(UDRE0))) {
            }
            UDR0 = frame[i];
        }
    }
}
