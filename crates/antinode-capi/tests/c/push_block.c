/*
 * Cost of the _push_block functions on a Cortex-M4: instructions per sample pair, from half-buffers of a tracked wave, with blocks queued;
 * _solve empties the queue, and is not counted. firmware/examples/push_block.rs is the same in Rust.
 *
 * In QEMU with -icount shift=0,align=off,sleep=off every instruction takes 1 ns, and SysTick counts the 168 MHz of the core.
 */
#include "counts.h"

/* Pairs before the measurement. */
enum { FIRST = 2000 };
enum form { PACKED, INTERLEAVED, SEPARATE };

static state_t gyro;
static sample_t interleaved[2 * RING], c[RING], d[RING];

/* Ticks that it took to push pairs `at` to `to` of the endless stream. */
static uint32_t run(enum form form, uint32_t at, uint32_t to)
{
    uint32_t ticks = 0;
    antinode_estimate_t estimate;
    while (at < to) {
        const uint32_t from = at % RING, count = next_pairs(at, to);
        const uint32_t begin = now();
        if (form == PACKED)
            CALL(push_block_packed)(&gyro, _binary_codes_bin_start + from, count);
        else if (form == INTERLEAVED)
            CALL(push_block_interleaved)(&gyro, interleaved + 2 * from, count);
        else
            CALL(push_block)(&gyro, c + from, d + from, count);
        ticks += (begin - now()) & 0xffffffu;
        while (CALL(solve)(&gyro, &estimate) == ANTINODE_ESTIMATE)
            ;
        at += count;
    }
    return ticks;
}

int main(void)
{
    static const char *const names[] = {"packed", "interleaved", "separate"};
    int i, watch;

    for (i = 0; i < RING; i++) {
        const uint32_t word = _binary_codes_bin_start[i];
        c[i] = interleaved[2 * i] = (int16_t)(uint16_t)word;
        d[i] = interleaved[2 * i + 1] = (int16_t)(uint16_t)(word >> 16);
    }
    SYSTICK[1] = 0xffffffu;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5; /* on, at the core's clock */
    for (watch = 0; watch < 2; watch++) {
        for (i = 0; i < 3; i++) {
            antinode_settings_t settings = antinode_settings_default(100e3);
            uint32_t thousandths;
            settings.watch = (uint32_t)watch;
            if (CALL(init)(&gyro, &settings) != ANTINODE_OK)
                return 1;
            run((enum form)i, 0, FIRST);
            thousandths = (uint32_t)((uint64_t)run((enum form)i, FIRST, FIRST + PAIRS) * 1000000 / 168 / PAIRS);
            printf("%s %s %s %lu.%03lu\n", NAME, watch ? "watch" : "plain", names[i], (unsigned long)thousandths / 1000,
                   (unsigned long)thousandths % 1000);
        }
    }
    return 0;
}
