/* Which cells are believed: an open or a broken bridge is seen in its counts.
 *
 * The ADS131M04 has no burn-out current sources, so the board's bias resistors drive an open
 * input out of range (docs/foot-board.md, "Open cells"). A live 24-bit channel never repeats the
 * very same count for long; one that does is stuck.
 */
#ifndef CELL_CHECK_H
#define CELL_CHECK_H

#include "frame_encoder.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CELL_CLIP 8257536L
/* 63/64 of full scale: no cell that fits its foot comes near it. */
#define CELL_STUCK_SAMPLES 8
/* Equal counts in a row. With the ADC's noise of 0.8 uV and a count of 2.2 nV two neighbours are
 * equal once in 1300 samples, so chance does this once in 1300^7 samples. */
#define CELL_RECOVERY_SAMPLES 50
/* Good samples in a row before a cell is believed, at the start too: loose contacts flicker. */

struct cell_check {
    int32_t last[FOOT_CELLS];
    uint8_t same[FOOT_CELLS];  /* counts in a row that equal the one before */
    uint8_t good[FOOT_CELLS];  /* good samples in a row */
};

void cell_check_start(struct cell_check *check);

/* Take one sample, of which only the cells in `valid` were converted well; the mask of cells to
 * believe. A bad conversion says nothing about its cell: it costs one sample, no recovery. */
uint8_t cell_check_update(struct cell_check *check, const int32_t counts[FOOT_CELLS],
                          uint8_t valid);

#ifdef __cplusplus
}
#endif

#endif
