/*
 * What a core costs that is given as TARGET: instructions per sample pair of _push_block_packed, without the watch and with it, and
 * thousands of instructions per window of _solve, of 10 and of 50 periods; and the stack, in bytes, of _init and of _solve.
 *
 * In QEMU with -icount shift=0,align=off,sleep=off every instruction takes 1 ns, and SysTick counts the 168 MHz of the core.
 */
#include "counts.h"

/* Pairs before the measurement. */
enum { FIRST = 2000 };

static state_t gyro;
static antinode_estimate_t estimate;
/* The most that a call took, bytes. */
static uint32_t stack_of_init, stack_of_solve;

static __attribute__((noinline)) antinode_status_t init(const antinode_settings_t *settings)
{
    volatile uint32_t *top = paint_stack();
    const antinode_status_t status = CALL(init)(&gyro, settings);
    const uint32_t taken = stack_taken(top);
    if (taken > stack_of_init)
        stack_of_init = taken;
    return status;
}

/* Solves what is queued; gives the windows that it solved. */
static __attribute__((noinline)) uint32_t solve(uint64_t *ticks)
{
    volatile uint32_t *top = paint_stack();
    const uint32_t begin = now();
    uint32_t windows = 0, taken;
    while (CALL(solve)(&gyro, &estimate) == ANTINODE_ESTIMATE)
        windows++;
    *ticks += (begin - now()) & 0xffffffu;
    taken = stack_taken(top);
    if (taken > stack_of_solve)
        stack_of_solve = taken;
    return windows;
}

/* Ticks that pushing and solving took, and windows solved. */
struct cost {
    uint64_t pushing, solving;
    uint32_t windows;
};

static struct cost run(uint32_t at, uint32_t to)
{
    struct cost cost = {0, 0, 0};
    while (at < to) {
        const uint32_t from = at % RING, count = next_pairs(at, to);
        const uint32_t begin = now();
        CALL(push_block_packed)(&gyro, _binary_codes_bin_start + from, count);
        cost.pushing += (begin - now()) & 0xffffffu;
        cost.windows += solve(&cost.solving);
        at += count;
    }
    return cost;
}

int main(void)
{
    static const uint32_t watches[] = {0, 1, 1}, periods[] = {10, 10, 50};
    struct cost cost[3];
    uint32_t tenths[2], thousands[2];
    int i;

    SYSTICK[1] = 0xffffffu;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5; /* on, at the core's clock */
    for (i = 0; i < 3; i++) {
        antinode_settings_t settings = antinode_settings_default(100e3);
        settings.watch = watches[i];
        settings.periods = periods[i];
        if (init(&settings) != ANTINODE_OK)
            return 1;
        run(0, FIRST);
        cost[i] = run(FIRST, FIRST + PAIRS);
        if (cost[i].windows == 0)
            return 1;
    }
    for (i = 0; i < 2; i++) {
        tenths[i] = (uint32_t)(cost[i].pushing * 10000 / 168 / PAIRS);
        thousands[i] = (uint32_t)(cost[i + 1].solving * 10 / 168 / cost[i + 1].windows);
    }
    printf("%s %lu.%lu %lu.%lu %lu.%lu %lu.%lu %lu %lu\n", NAME, (unsigned long)tenths[0] / 10, (unsigned long)tenths[0] % 10,
           (unsigned long)tenths[1] / 10, (unsigned long)tenths[1] % 10, (unsigned long)thousands[0] / 10, (unsigned long)thousands[0] % 10,
           (unsigned long)thousands[1] / 10, (unsigned long)thousands[1] % 10, (unsigned long)stack_of_init, (unsigned long)stack_of_solve);
    return 0;
}
