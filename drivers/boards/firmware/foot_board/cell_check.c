/* Open, broken and stuck cells (docs/foot-board.md, "Open cells"). */
#include "cell_check.h"

void cell_check_start(struct cell_check *check)
{
    static const struct cell_check fresh = {{0}, {0}, {0}};

    *check = fresh;
}

static uint8_t believed(struct cell_check *check, uint8_t cell, int32_t count)
{
    uint8_t *same = &check->same[cell];
    uint8_t *good = &check->good[cell];

    if (count != check->last[cell]) {
        *same = 0;
    } else if (*same < CELL_STUCK_SAMPLES) {
        (*same)++;
    }
    check->last[cell] = count;
    if (count >= CELL_CLIP || count <= -CELL_CLIP || *same + 1 >= CELL_STUCK_SAMPLES) {
        *good = 0;
    } else if (*good < CELL_RECOVERY_SAMPLES) {
        (*good)++;
    }
    return *good >= CELL_RECOVERY_SAMPLES;
}

uint8_t cell_check_update(struct cell_check *check, const int32_t counts[FOOT_CELLS],
                          uint8_t valid)
{
    uint8_t mask = 0;
    uint8_t cell;

    for (cell = 0; cell < FOOT_CELLS; cell++) {
        if ((valid >> cell & 1u) && believed(check, cell, counts[cell])) {
            mask = (uint8_t)(mask | 1u << cell);
        }
    }
    return mask;
}
