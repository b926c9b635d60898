/*
 * 16384 pairs through _push_block_packed between two marks, from half-buffers, for a tool that counts instructions. Nothing is
 * solved between them (unless DRAIN is defined), so the sums are all that is measured; WATCH is that of the settings.
 */

#if defined(FLOAT)
#define STATE antinode_float_t
#define CALL(name) antinode_float_##name
#else
#define STATE antinode_fixed_t
#define CALL(name) antinode_fixed_##name
#endif

#ifndef WATCH
#define WATCH 0
#endif

enum { RING = 1406, HALF_BUFFER = 128, FIRST = 1000, PAIRS = 16384 };

extern const uint32_t _binary_codes_bin_start[RING];
void mark_begin(void);
void mark_end(void);

static STATE gyro;
static volatile int mark;

__attribute__((noinline)) void mark_begin(void) { mark = 1; }
__attribute__((noinline)) void mark_end(void) { mark = 2; }

static void run(uint32_t at, uint32_t to)
{
    while (at < to) {
        const uint32_t from = at % RING;
        uint32_t count = to - at < HALF_BUFFER ? to - at : HALF_BUFFER;
        if (count > RING - from)
            count = RING - from;
        CALL(push_block_packed)(&gyro, _binary_codes_bin_start + from, count);
#ifdef DRAIN
        antinode_estimate_t estimate;
        CALL(solve)(&gyro, &estimate);
#endif
        at += count;
    }
}

int main(void)
{
    antinode_settings_t settings = antinode_settings_default(100e3);
    settings.watch = WATCH;
    CALL(init)(&gyro, &settings);
    run(0, FIRST);
    mark_begin();
    run(FIRST, FIRST + PAIRS);
    mark_end();
    return 0;
}
