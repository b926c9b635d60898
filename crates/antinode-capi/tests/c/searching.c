/*
 * Costs of the interrupt side on the core of TARGET: instructions a sample pair during the search for a period, from half-buffers of noise
 * with either detector and of tones that are never found, and pair by pair in a wave; the same in noise at a known frequency; the most
 * instructions of one _push; and the most stack of any call, without the processor's own frame. Counted as in per_core.c. In fixed point
 * the floating-point unit is off once the period is known: an instruction of it would end in the fault handler.
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
static int is_told; /* true if the next call of the interrupt side searches anew, or gathers a first block */
static int gauges_stack; /* true if pushes measure it, which takes a hundred times as long as to push a pair */

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
    top = gauges_stack ? paint_stack() : 0;
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
    taken = gauges_stack ? stack_taken(top) : 0;
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

/* `size` times the sine, within 0.1 %, of a phase in 2^-32 turns; in integers, for most of the cores have no others. */
static int32_t sine(int32_t size, uint32_t phase)
{
    const int32_t x = (int32_t)phase >> 16, y = x * (32768 - (x < 0 ? -x : x)) >> 13;
    return size * (y + (y * ((y < 0 ? -y : y) - 32768) >> 15) * 225 / 1000) >> 15;
}

/*
 * Pushes half-buffers of two tones of equal amplitude, whose periods are in hundredths of a sample pair, until a wave is found in them and
 * its first block is finished; raises `most` to the most instructions a pair that a half-buffer took. Returns 1 if no wave is found.
 */
static int tones(const antinode_settings_t *settings, uint32_t period, uint32_t other, uint32_t *most)
{
    uint32_t pushed[HALF_BUFFER], at, i, p = 0, q = 0, here, found = 0;

    CALL(init)(&gyro, settings);
    for (at = 0; at < PAIRS / 6; at += HALF_BUFFER) {
        for (i = 0; i < HALF_BUFFER; i++) {
            const int32_t x = sine(1000, p) + sine(1000, q);
            pushed[i] = (uint16_t)x | (uint32_t)(x * 3 / 5) << 16;
            p += (uint32_t)((100ull << 32) / period);
            q += (uint32_t)((100ull << 32) / other);
        }
        take(pushed, HALF_BUFFER);
        ticks = pairs = 0;
        is_told = found > 0; /* the first block */
        push(PACKED, HALF_BUFFER);
        here = (uint32_t)((uint64_t)ticks * 1000 / MHZ / pairs);
        *most = here > *most ? here : *most;
        CALL(health)(&gyro, &health);
        if (!health.searching && found++ == 2)
            break;
    }
    return found == 0;
}

/* Two tones of many periods, and one that is too fast, with the same; returns in how many no wave is found. */
static uint32_t all_tones(const antinode_settings_t *settings, uint32_t *most)
{
    uint32_t period, percent, count = 0;

    for (period = 200; period < 400; period += 20)
        count += (uint32_t)tones(settings, period, period, most);
    for (period = 400; period < 3000; period = period * 5 / 4)
        for (percent = 160; percent <= 240; percent += 20)
            count += (uint32_t)tones(settings, period, period * percent / 100, most);
    return count;
}

/* Prints the instructions a pair since the last call; returns them rounded. */
static uint32_t print(const char *what)
{
    const uint32_t thousandths = (uint32_t)((uint64_t)ticks * 1000000 / MHZ / pairs);
    printf("%s %s %lu.%03lu\n", NAME, what, (unsigned long)thousandths / 1000, (unsigned long)thousandths % 1000);
    ticks = pairs = 0;
    return (thousandths + 500) / 1000;
}

/* The next word of noise: codes from 0 to 255. */
static uint32_t random_word(void)
{
    static uint32_t seed = 7;
    seed = seed * 1664525 + 1013904223;
    return (seed >> 8 & 0xff) | (seed & 0xff0000);
}

/*
 * Pushes half-buffers of noise; returns the instructions a pair, and raises `most` to those of the half-buffer that took most. Returns 0
 * if the state does not search for a period to the end, or, at a known frequency, if it does.
 */
static uint32_t noise(const antinode_settings_t *settings, const char *what, uint32_t *most)
{
    uint32_t pushed[HALF_BUFFER], at, i, before = 0, here, mean;

    if (CALL(init)(&gyro, settings) != ANTINODE_OK)
        return 0;
    for (at = 0; at < PAIRS; at += HALF_BUFFER) {
        for (i = 0; i < HALF_BUFFER; i++)
            pushed[i] = random_word();
        take(pushed, HALF_BUFFER);
        is_told = at < ANTINODE_LONGEST_PERIOD; /* at a known frequency, the first block */
        push(PACKED, HALF_BUFFER);
        here = (uint32_t)((uint64_t)(ticks - before) * 1000 / MHZ / HALF_BUFFER);
        *most = here > *most ? here : *most;
        before = ticks;
    }
    mean = print(what);
    return CALL(health)(&gyro, &health) == ANTINODE_OK && health.searching == (settings->frequency_hz == 0) ? mean : 0;
}

int main(void)
{
    const antinode_settings_t settings = antinode_settings_default(100e3);
    static const char *const names[] = {"packed", "interleaved", "separate", "single"};
    uint32_t at, i, count, form;
    antinode_settings_t other = settings;
    uint32_t word, tracked = 0, mean[3], most[3] = {0, 0, 0}, taken;

    SYSTICK[1] = 0xffffffu;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5; /* on, at the core's clock */

    mean[0] = noise(&settings, "noise", most);
    other.detection = ANTINODE_DETECTION_MEAN_RETURN;
    mean[1] = noise(&other, "noise, mean return", most + 1);
    if (mean[0] == 0 || mean[1] == 0)
        return 1;
    /* In 53 of these 60 pairs of tones no wave is found. */
    taken = 0;
    if (all_tones(&settings, &taken) < 50)
        return 1;
    printf("%s tones, most %lu\n", NAME, (unsigned long)taken);
    most[0] = taken > most[0] ? taken : most[0];
    all_tones(&other, most + 1);
    /* The slower a wave is, the longer the other detector's trial. */
    if (tones(&other, 10000, 10000, most + 1) || tones(&other, 19000, 19000, most + 1))
        return 1;
    /* The slower a wave, the longer its first block, which makes tables. */
    ticks = pairs = 0;
    other.frequency_hz = 100e3f / 190;
    if (noise(&other, "noise, low frequency known", most + 2) == 0)
        return 1;
    other.frequency_hz = 5332;
    mean[2] = noise(&other, "noise, frequency known", most + 2);
    if (mean[2] == 0)
        return 1;
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
        word = random_word();
        if (kind > 1) {
            word = (uint16_t)sine(1500, at * (0xffffffffu / period));
            word |= (uint32_t)sine(1500, at * (0xffffffffu / period / 10 * (kind * 4 + 1))) << 16;
        }
        take(kind == 1 ? _binary_codes_bin_start + at % RING : &word, 1);
        is_told = 1; /* _solve asks for a search when it finds no wave in noise */
        push(SINGLE, 1);
        while (CALL(solve)(&gyro, &estimate) == ANTINODE_ESTIMATE)
            ;
    }
    taken = (uint32_t)(most_ticks * 1000ull / MHZ);
    printf("%s single, at once %lu\n", NAME, (unsigned long)taken);
    printf("%s row %lu %lu %lu", NAME, (unsigned long)mean[0], (unsigned long)most[0], (unsigned long)taken);
    printf(" %lu %lu %lu %lu\n", (unsigned long)mean[1], (unsigned long)most[1], (unsigned long)mean[2], (unsigned long)most[2]);

    gauges_stack = 1;
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
