/*
 * Costs on the core of TARGET: instructions per sample pair of _push_block_packed, without the watch and with it; thousands of instructions
 * of _solve per window of 10 and of 50 periods, for the first window of 10 periods of a wave, and per window of noise at a known frequency;
 * and the stack, in bytes, of _init, of _solve, of every push function and of _identify, with the settings that take most. Unaligned accesses
 * are trapped: one would end in the fault handler.
 *
 * In QEMU with -icount shift=0,align=off,sleep=off every instruction takes 1 ns, and SysTick counts the 168 MHz of the core.
 */
#include "counts.h"

/* Pairs before the measurement. */
enum { FIRST = 2000 };
enum form { SINGLE, SEPARATE, INTERLEAVED, PACKED, FORMS };

static state_t gyro;
/* Separate arrays of codes need no alignment to words; those with C and D in turn do. */
static sample_t interleaved[2 * HALF_BUFFER] __attribute__((aligned(4))), arrays[2 * HALF_BUFFER + 1] __attribute__((aligned(4)));
static sample_t *const c = arrays + 1, *const d = arrays + 1 + HALF_BUFFER;
static antinode_estimate_t estimate;
/* The most stack that a call took, bytes. */
static uint32_t stack_of_init, stack_of_solve, stack_of_push[FORMS], stack_of_identify;

static void trap_unaligned(int on)
{
    *(volatile uint32_t *)0xE000ED14u = on ? 1u << 3 | 1u << 9 : 1u << 9; /* CCR: UNALIGN_TRP, and STKALIGN as it was */
    __asm volatile("dsb\n isb" ::: "memory");
}

static __attribute__((noinline)) antinode_status_t init(const antinode_settings_t *settings)
{
    volatile uint32_t *top = paint_stack();
    const antinode_status_t status = CALL(init)(&gyro, settings);
    const uint32_t taken = stack_taken(top);
    if (taken > stack_of_init)
        stack_of_init = taken;
    return status;
}

/* Solves the queued blocks; returns how many windows that gave. */
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

/* Ticks that pushing, solving and the longest solution took, and windows solved. */
struct cost {
    uint64_t pushing, solving, longest;
    uint32_t windows;
};

static struct cost run(uint32_t at, uint32_t to)
{
    struct cost cost = {0, 0, 0, 0};
    while (at < to) {
        const uint32_t from = at % RING, count = next_pairs(at, to);
        const uint32_t begin = now();
        uint64_t ticks = 0;
        CALL(push_block_packed)(&gyro, _binary_codes_bin_start + from, count);
        cost.pushing += (begin - now()) & 0xffffffu;
        cost.windows += solve(&ticks);
        cost.solving += ticks;
        if (ticks > cost.longest)
            cost.longest = ticks;
        at += count;
    }
    return cost;
}

/* Solves noise of up to 1024 codes as a wave of 5332 Hz; returns the ticks that took, 0 if a wave was found. */
static uint64_t solve_noise(void)
{
    antinode_settings_t settings = antinode_settings_default(100e3);
    uint32_t at, i, seed = 1;
    uint64_t ticks = 0;

    settings.frequency_hz = 5332;
    if (init(&settings) != ANTINODE_OK)
        return 0;
    for (at = 0; at < PAIRS; at += HALF_BUFFER) {
        for (i = 0; i < 2 * HALF_BUFFER; i++) {
            seed = seed * 1664525u + 1013904223u;
            interleaved[i] = (sample_t)((int32_t)(seed >> 21) - 1024);
        }
        CALL(push_block_interleaved)(&gyro, interleaved, HALF_BUFFER);
        if (solve(&ticks) > 0)
            return 0;
    }
    return ticks;
}

static __attribute__((noinline)) void push(enum form form, const uint32_t *words, uint32_t count)
{
    volatile uint32_t *top = paint_stack();
    uint32_t i, taken;
    if (form == PACKED)
        CALL(push_block_packed)(&gyro, words, count);
    else if (form == INTERLEAVED)
        CALL(push_block_interleaved)(&gyro, interleaved, count);
    else if (form == SEPARATE)
        CALL(push_block)(&gyro, c, d, count);
    else
        for (i = 0; i < count; i++)
            CALL(push)(&gyro, c[i], d[i]);
    taken = stack_taken(top);
    if (taken > stack_of_push[form])
        stack_of_push[form] = taken;
}

/* Fills every array with the codes from pair `at` of the endless stream on. */
static void fill(uint32_t at)
{
    uint32_t i;
    for (i = 0; i < HALF_BUFFER; i++) {
        const uint32_t word = _binary_codes_bin_start[(at + i) % RING];
        c[i] = interleaved[2 * i] = (int16_t)(uint16_t)word;
        d[i] = interleaved[2 * i + 1] = (int16_t)(uint16_t)(word >> 16);
    }
}

/* Pushes by one function, from cold to a full queue, with a search on the way; returns 1 if that gave windows. */
static int push_by(enum form form, const antinode_settings_t *settings)
{
    uint32_t at, count, windows = 0;
    uint64_t ticks = 0;

    if (init(settings) != ANTINODE_OK)
        return 0;
    for (at = 0; at < PAIRS; at += count) {
        count = next_pairs(at, UINT32_MAX);
        fill(at);
        push(form, _binary_codes_bin_start + at % RING, count);
        if (at < PAIRS / 2 && at + count >= PAIRS / 2)
            CALL(search)(&gyro);
        if (at < 3 * PAIRS / 4)
            windows += solve(&ticks);
    }
    return windows > 50;
}

/* Identifies from cold; returns how many windows that gave. */
static __attribute__((noinline)) uint32_t identify(void)
{
    volatile uint32_t *top = paint_stack();
    uint32_t at, windows = 0, stack;
    for (at = 0; at < PAIRS; at += HALF_BUFFER) {
        size_t done = 0, taken;
        while (done < HALF_BUFFER) {
            windows += CALL(identify)(&gyro, interleaved + 2 * done, HALF_BUFFER - done, &taken, &estimate) == ANTINODE_ESTIMATE;
            done += taken;
        }
        fill(at + HALF_BUFFER);
    }
    stack = stack_taken(top);
    if (stack > stack_of_identify)
        stack_of_identify = stack;
    return windows;
}

/* Runs with settings that take more stack than the usual ones: block offsets, and the other detector. Returns 1 if that gave windows. */
static int call_with(uint32_t hum, uint32_t detection)
{
    antinode_settings_t settings = antinode_settings_default(100e3);
    settings.hum = hum;
    settings.detection = detection;
    if (init(&settings) != ANTINODE_OK || run(0, PAIRS).windows == 0 || init(&settings) != ANTINODE_OK)
        return 0;
    fill(0);
    return identify() > 0;
}

/* Calls the functions that are called only now and then; returns 1 if each did its work. */
static int call_the_others(void)
{
    antinode_health_t health;
    antinode_calibration_t calibration = antinode_settings_default(1).calibration;
    size_t taken;

    calibration.gain_ratio = 1.1f;
    return CALL(set_calibration)(&gyro, &calibration) == ANTINODE_OK && CALL(skip)(&gyro, 7) == ANTINODE_OK &&
           CALL(health)(&gyro, &health) == ANTINODE_OK && CALL(reset)(&gyro) == ANTINODE_OK &&
           CALL(identify)(&gyro, interleaved, HALF_BUFFER, &taken, &estimate) == ANTINODE_OK &&
           antinode_status_string(ANTINODE_OK)[0] == 'd' && antinode_version() == ANTINODE_VERSION;
}

int main(void)
{
    static const uint32_t watches[] = {0, 1, 1}, periods[] = {10, 10, 50};
    struct cost cost[3];
    uint32_t tenths[2], thousands[4];
    uint64_t first = 0, noise;
    int i;

    trap_unaligned(1);
    SYSTICK[1] = 0xffffffu;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5; /* on, at the core's clock */
    for (i = 0; i < 3; i++) {
        antinode_settings_t settings = antinode_settings_default(100e3);
        settings.watch = watches[i];
        settings.periods = periods[i];
        if (init(&settings) != ANTINODE_OK)
            return 1;
        cost[i] = run(0, FIRST);
        if (i == 1)
            first = cost[i].longest;
        cost[i] = run(FIRST, FIRST + PAIRS);
        if (cost[i].windows == 0)
            return 1;
    }
    for (i = 0; i < 2; i++) {
        tenths[i] = (uint32_t)(cost[i].pushing * 10000 / 168 / PAIRS);
        thousands[i] = (uint32_t)(cost[i + 1].solving * 10 / 168 / cost[i + 1].windows);
    }
    noise = solve_noise();
    if (noise == 0)
        return 1;
    thousands[2] = (uint32_t)(first * 10 / 168);
    /* 187.5 pairs a window. */
    thousands[3] = (uint32_t)(noise * 1875 / 168 / PAIRS);
    for (i = SINGLE; i < FORMS; i++) {
        const antinode_settings_t settings = antinode_settings_default(100e3);
        if (!push_by((enum form)i, &settings))
            return 1;
    }
    if (!call_the_others() || !call_with(1, 0) || !call_with(0, ANTINODE_DETECTION_MEAN_RETURN))
        return 1;
    trap_unaligned(0);
    printf("%s", NAME);
    for (i = 0; i < 2; i++)
        printf(" %lu.%lu", (unsigned long)tenths[i] / 10, (unsigned long)tenths[i] % 10);
    for (i = 0; i < 4; i++)
        printf(" %lu.%lu", (unsigned long)thousands[i] / 10, (unsigned long)thousands[i] % 10);
    printf(" %lu %lu %lu %lu %lu %lu %lu\n", (unsigned long)stack_of_init, (unsigned long)stack_of_solve, (unsigned long)stack_of_push[SINGLE],
           (unsigned long)stack_of_push[SEPARATE], (unsigned long)stack_of_push[INTERLEAVED], (unsigned long)stack_of_push[PACKED],
           (unsigned long)stack_of_identify);
    return 0;
}
