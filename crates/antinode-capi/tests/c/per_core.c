/*
 * Costs on the core of TARGET: instructions per sample pair of _push_block_packed, without the watch and with it; thousands of instructions
 * of _solve per window of 10 and of 50 periods, for the first window of 10 periods of a wave, per window of noise at a known frequency, and of the
 * longest call in noise with the settings that take most; and the stack, in bytes, of _init, of _reset, of _solve, of every push function
 * and of _identify, with the settings that take most. Unaligned accesses are trapped: one would end in the fault handler.
 *
 * In QEMU with -icount shift=0,align=off,sleep=off every instruction takes 1 ns, and SysTick counts the clock of the core.
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
static uint32_t stack_of_init, stack_of_reset, stack_of_solve, stack_of_push[FORMS], stack_of_identify, stack_of_others;

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

/* Solves full queues of noise, as windows of 50 periods of 150 pairs that overlap, with hum; returns the ticks of the longest call. */
static uint32_t longest_call(void)
{
    antinode_settings_t settings = antinode_settings_default(100e3);
    antinode_health_t health;
    uint32_t word, calls, seed = 1, most = 0;

    settings.periods = ANTINODE_MOST_PERIODS;
    settings.hop_blocks = 1;
    settings.hum = 1;
    settings.frequency_hz = 100e3f / 150;
    if (CALL(init)(&gyro, &settings) != ANTINODE_OK)
        return 0;
    for (calls = 0; calls < 24; calls++) {
        do {
            seed = seed * 1664525u + 1013904223u;
            word = seed >> 11 & 0xff00ffu;
            CALL(push_block_packed)(&gyro, &word, 1);
            CALL(health)(&gyro, &health);
        } while (health.waiting < ANTINODE_QUEUE_BLOCKS);
        word = now();
        CALL(solve)(&gyro, &estimate);
        word = (word - now()) & 0xffffffu;
        most = word > most ? word : most;
    }
    return health.dropped == 0 ? most : 0;
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

/* Makes a call, and keeps in `most` the stack that it took. */
#define GAUGE(most, call) \
    do { \
        volatile uint32_t *const top = paint_stack(); \
        uint32_t taken; \
        call; \
        taken = stack_taken(top); \
        (most) = taken > (most) ? taken : (most); \
    } while (0)

/* Calls the functions that are called only now and then, in a wave; returns 1 if each did its work. */
static __attribute__((noinline)) int call_the_others(antinode_settings_t settings)
{
    antinode_health_t health;
    antinode_status_t status[5];
    const char *text;
    uint32_t version;
    size_t size;

    settings.calibration.gain_ratio = 1.1f;
    GAUGE(stack_of_others, status[0] = CALL(set_calibration)(&gyro, &settings.calibration));
    run(0, FIRST);
    GAUGE(stack_of_others, status[1] = CALL(skip)(&gyro, 7));
    GAUGE(stack_of_others, status[2] = CALL(search)(&gyro));
    /* Now this searches anew as well. */
    GAUGE(stack_of_others, status[1] = CALL(skip)(&gyro, UINT32_MAX));
    GAUGE(stack_of_others, status[3] = CALL(health)(&gyro, &health));
    GAUGE(stack_of_others, settings = antinode_settings_default(1));
    GAUGE(stack_of_others, text = antinode_status_string(ANTINODE_ERROR_COLOURED));
    GAUGE(stack_of_others, version = antinode_version());
    GAUGE(stack_of_others, size = CALL(size)());
    GAUGE(stack_of_reset, status[4] = CALL(reset)(&gyro));
    return status[0] == ANTINODE_OK && status[1] == ANTINODE_OK && status[2] == ANTINODE_OK && status[3] == ANTINODE_OK &&
           status[4] == ANTINODE_OK && text[0] == 'c' && version == ANTINODE_HEADER_VERSION && size == sizeof gyro;
}

/* Runs with settings that take more stack than the usual ones: block offsets, and the other detector. Returns 1 if that gave windows. */
static int call_with(uint32_t hum, uint32_t detection)
{
    antinode_settings_t settings = antinode_settings_default(100e3);
    settings.hum = hum;
    settings.detection = detection;
    if (init(&settings) != ANTINODE_OK || run(0, PAIRS).windows == 0 || !call_the_others(settings) || init(&settings) != ANTINODE_OK)
        return 0;
    fill(0);
    return identify() > 0;
}

int main(void)
{
    static const uint32_t watches[] = {0, 1, 1}, periods[] = {10, 10, 50};
    struct cost cost[3];
    uint32_t tenths[2], thousands[5];
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
        tenths[i] = (uint32_t)(cost[i].pushing * 10000 / MHZ / PAIRS);
        thousands[i] = (uint32_t)(cost[i + 1].solving * 10 / MHZ / cost[i + 1].windows);
    }
    noise = solve_noise();
    if (noise == 0)
        return 1;
    thousands[2] = (uint32_t)(first * 10 / MHZ);
    /* 187.5 pairs a window. */
    thousands[3] = (uint32_t)(noise * 1875 / MHZ / PAIRS);
    thousands[4] = (uint32_t)(longest_call() * 10ull / MHZ);
    if (thousands[4] == 0)
        return 1;
    for (i = SINGLE; i < FORMS; i++) {
        const antinode_settings_t settings = antinode_settings_default(100e3);
        if (!push_by((enum form)i, &settings))
            return 1;
    }
    if (!call_with(1, 0) || !call_with(0, ANTINODE_DETECTION_MEAN_RETURN))
        return 1;
    /* As README.md says of all functions that it does not list. */
    if (stack_of_others > 250)
        return 1;
    trap_unaligned(0);
    printf("%s", NAME);
    for (i = 0; i < 2; i++)
        printf(" %lu.%lu", (unsigned long)tenths[i] / 10, (unsigned long)tenths[i] % 10);
    for (i = 0; i < 5; i++)
        printf(" %lu.%lu", (unsigned long)thousands[i] / 10, (unsigned long)thousands[i] % 10);
    printf(" %lu %lu %lu %lu %lu %lu %lu %lu\n", (unsigned long)stack_of_init, (unsigned long)stack_of_reset, (unsigned long)stack_of_solve,
           (unsigned long)stack_of_push[SINGLE], (unsigned long)stack_of_push[SEPARATE], (unsigned long)stack_of_push[INTERLEAVED],
           (unsigned long)stack_of_push[PACKED], (unsigned long)stack_of_identify);
    return 0;
}
