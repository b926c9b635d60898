/*
 * Costs of the interrupt side on a Cortex-M4: instructions a sample pair during the search for a period, from half-buffers of noise and of
 * tones that are never found, and pair by pair in a wave; the most instructions of one _push; and the most stack of any call, without the
 * processor's own frame. Counted as in push_block.c. In fixed point the floating-point unit is off once the period is known: an instruction
 * of it would end in the fault handler.
 */
#include "counts.h"

enum { FROM_COLD = 100 };
enum form { PACKED, INTERLEAVED, SEPARATE, SINGLE };

static state_t gyro;
static uint32_t words[HALF_BUFFER];
static sample_t interleaved[2 * HALF_BUFFER], c[HALF_BUFFER], d[HALF_BUFFER];
static antinode_estimate_t estimate;
static antinode_health_t health;
static uint32_t ticks, pairs, most_stack, most_ticks;
static int is_told; /* true if the next call of the interrupt side searches anew, because the thread side asked for it */

static void fpu(int on)
{
    *(volatile uint32_t *)0xE000ED88u = on ? 0xFu << 20 : 0; /* CPACR */
    __asm volatile("dsb\n isb" ::: "memory");
}

/* Pushes `count` pairs, and measures instructions and stack. */
static __attribute__((noinline)) void push(enum form form, uint32_t count)
{
    volatile uint32_t *top;
    uint32_t begin, taken, i;

    if (CALL(health)(&gyro, &health) == ANTINODE_OK && sizeof(sample_t) == 2)
        fpu(health.searching || is_told);
    is_told = 0;
    top = paint_stack();
    begin = now();
    if (form == PACKED)
        CALL(push_block_packed)(&gyro, words, count);
    else if (form == INTERLEAVED)
        CALL(push_block_interleaved)(&gyro, interleaved, count);
    else if (form == SEPARATE)
        CALL(push_block)(&gyro, c, d, count);
    else
        for (i = 0; i < count; i++)
            CALL(push)(&gyro, c[i], d[i]);
    taken = (begin - now()) & 0xffffffu;
    ticks += taken;
    pairs += count;
    if (form == SINGLE && count == 1 && taken > most_ticks)
        most_ticks = taken;
    fpu(1);
    taken = stack_taken(top);
    if (taken > most_stack)
        most_stack = taken;
}

static void take(const uint32_t *from, uint32_t count)
{
    uint32_t i;
    for (i = 0; i < count; i++) {
        words[i] = from[i];
        c[i] = interleaved[2 * i] = (int16_t)(uint16_t)words[i];
        d[i] = interleaved[2 * i + 1] = (int16_t)(uint16_t)(words[i] >> 16);
    }
}

/* Sine of a phase in 2^-32 turns, within 0.1 %. */
static float sine(uint32_t phase)
{
    const float x = (float)(int32_t)phase / 2147483648.0f, y = 4.0f * x * (1.0f - (x < 0 ? -x : x));
    return y + 0.225f * y * ((y < 0 ? -y : y) - 1.0f);
}

/*
 * Pushes half-buffers of two tones of equal amplitude, whose periods are in hundredths of a sample pair; returns the most instructions a
 * pair that a half-buffer took, or 0 if a wave is found in them.
 */
static uint32_t tones(const antinode_settings_t *settings, uint32_t period, uint32_t other)
{
    uint32_t pushed[HALF_BUFFER], at, i, p = 0, q = 0, most = 0, here;

    CALL(init)(&gyro, settings);
    for (at = 0; at < PAIRS; at += HALF_BUFFER) {
        for (i = 0; i < HALF_BUFFER; i++) {
            const float x = 1000.0f * (sine(p) + sine(q));
            pushed[i] = (uint16_t)(int16_t)x | (uint32_t)(uint16_t)(int16_t)(0.6f * x) << 16;
            p += (uint32_t)((100ull << 32) / period);
            q += (uint32_t)((100ull << 32) / other);
        }
        take(pushed, HALF_BUFFER);
        ticks = pairs = 0;
        push(PACKED, HALF_BUFFER);
        if (CALL(health)(&gyro, &health) != ANTINODE_OK || health.searching != 1)
            return 0;
        here = ticks / 168 * 1000 / pairs;
        if (here > most)
            most = here;
    }
    return most;
}

/* Prints the instructions a pair since the last call. */
static void print(const char *what)
{
    const uint32_t thousandths = (uint32_t)((uint64_t)ticks * 1000000 / 168 / pairs);
    printf("%s %s %lu.%03lu\n", NAME, what, (unsigned long)thousandths / 1000, (unsigned long)thousandths % 1000);
    ticks = pairs = 0;
}

int main(void)
{
    const antinode_settings_t settings = antinode_settings_default(100e3);
    static const char *const names[] = {"packed", "interleaved", "separate", "single"};
    uint32_t at, i, count, form, seed = 7;
    uint32_t noise[HALF_BUFFER], tracked = 0, most, searched, taken;

    SYSTICK[1] = 0xffffffu;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5; /* on, at the core's clock */

    if (CALL(init)(&gyro, &settings) != ANTINODE_OK)
        return 1;
    for (at = 0; at < PAIRS; at += HALF_BUFFER) {
        for (i = 0; i < HALF_BUFFER; i++) {
            seed = seed * 1664525 + 1013904223;
            noise[i] = (seed >> 8 & 0xff) | (seed & 0xff0000);
        }
        take(noise, HALF_BUFFER);
        push(PACKED, HALF_BUFFER);
    }
    if (CALL(health)(&gyro, &health) != ANTINODE_OK || health.searching != 1)
        return 1;
    print("noise");

    most = searched = 0;
    for (at = 200; at < 400; at += 10, searched += taken > 0) {
        taken = tones(&settings, at, at);
        most = taken > most ? taken : most;
    }
    for (at = 400; at < 3000; at = at * 9 / 8)
        for (i = 160; i <= 240; i += 10, searched += taken > 0) {
            taken = tones(&settings, at, at * i / 100);
            most = taken > most ? taken : most;
        }
    /* In 142 of these 182 pairs of tones no wave is found. */
    if (searched < 140)
        return 1;
    printf("%s tones, most %lu\n", NAME, (unsigned long)most);
    ticks = pairs = 0;
    for (at = 0; at < RING - FROM_COLD; at += 29) {
        CALL(init)(&gyro, &settings);
        for (i = 0; CALL(health)(&gyro, &health) == ANTINODE_OK && health.searching && i < FROM_COLD; i++) {
            take(_binary_codes_bin_start + at + i, 1);
            push(SINGLE, 1);
        }
    }
    print("wave");
    /* In noise trial periods fail at once; with another frequency in each pick-off they fail late; and in the wave blocks begin. */
    CALL(init)(&gyro, &settings);
    for (at = 0; at < PAIRS; at++) {
        const uint32_t kind = at / 1024 % 4, period = 5 + at / 4096 * 7;
        seed = seed * 1664525 + 1013904223;
        noise[0] = (seed >> 8 & 0xff) | (seed & 0xff0000);
        if (kind > 1) {
            noise[0] = (uint16_t)(int16_t)(1500 * sine(at * (0xffffffffu / period)));
            noise[0] |= (uint32_t)(uint16_t)(int16_t)(1500 * sine(at * (0xffffffffu / period / 10 * (kind * 4 + 1)))) << 16;
        }
        take(kind == 1 ? _binary_codes_bin_start + at % RING : noise, 1);
        is_told = 1; /* _solve asks for a search when it finds no wave in noise */
        push(SINGLE, 1);
        while (CALL(solve)(&gyro, &estimate) == ANTINODE_ESTIMATE)
            ;
    }
    printf("%s single, at once %lu\n", NAME, (unsigned long)(most_ticks * 1000ull / 168));

    most_stack = 0;
    /* Every push function, from cold to a full queue, with a search on the way. */
    for (form = PACKED; form <= SINGLE; form++) {
        CALL(init)(&gyro, &settings);
        for (at = 0; at < 4 * PAIRS; at += count) {
            count = next_pairs(at, UINT32_MAX);
            take(_binary_codes_bin_start + at % RING, count);
            push((enum form)form, count);
            if (at < 2 * PAIRS && at + count >= 2 * PAIRS) {
                CALL(search)(&gyro);
                is_told = 1;
            }
            while (at < 3 * PAIRS && CALL(solve)(&gyro, &estimate) == ANTINODE_ESTIMATE)
                tracked += estimate.flags == 0;
        }
        if (tracked < 250)
            return 1;
        printf("%s %s, stack %lu\n", NAME, names[form], (unsigned long)most_stack);
        tracked = most_stack = 0;
    }
    return 0;
}
