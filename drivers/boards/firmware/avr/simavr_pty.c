/* Runs an ATmega328P firmware in simavr with its UART on a pty.
 *
 *     simavr_pty FIRMWARE.elf
 *
 * Prints a line "pty NAME", then runs until it is ended. Time is about the real one, because
 * simavr sleeps for as long as the firmware does.
 */
#define _GNU_SOURCE
#include <pty.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <stdio.h>
#include <termios.h>
#include <unistd.h>

enum { FREQUENCY = 16000000 };

static void put_byte(struct avr_irq_t *irq, uint32_t value, void *parameter)
{
    const int *master = parameter;
    const unsigned char byte = (unsigned char)value;

    (void)irq;
    /* While nobody reads, the pty is full and simulated time stands still: no byte is lost. */
    if (write(*master, &byte, 1) != 1) {
        perror("pty");
    }
}

int main(int argc, char **argv)
{
    elf_firmware_t firmware = {0};
    struct termios raw;
    char name[64];
    int master, slave;
    uint32_t flags = 0;
    avr_t *avr;

    if (argc != 2 || elf_read_firmware(argv[1], &firmware) != 0) {
        fprintf(stderr, "usage: simavr_pty FIRMWARE.elf\n");
        return 2;
    }
    avr = avr_make_mcu_by_name("atmega328p");
    if (avr == NULL || avr_init(avr) != 0) {
        fprintf(stderr, "simavr has no atmega328p\n");
        return 1;
    }
    firmware.frequency = FREQUENCY;
    avr_load_firmware(avr, &firmware);

    if (openpty(&master, &slave, name, NULL, NULL) != 0 || tcgetattr(slave, &raw) != 0) {
        perror("pty");
        return 1;
    }
    cfmakeraw(&raw);
    tcsetattr(slave, TCSANOW, &raw);

    /* Neither print the bytes as text nor slow down whoever polls the UART. */
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
                            put_byte, &master);
    printf("pty %s\n", name);
    fflush(stdout);
    for (;;) {
        int state = avr_run(avr);

        if (state == cpu_Done || state == cpu_Crashed) {
            fprintf(stderr, "the firmware ended\n");
            return 1;
        }
    }
}
