/*
 * Every function with NULL, misaligned and garbage states, absurd ranges and full-scale input. Compiled once for each arithmetic; run
 * under ASan with UBSan, and under valgrind.
 */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "antinode.h"

#if defined(FLOAT)
typedef float sample_t;
typedef antinode_float_t state_t;
#define CALL(name) antinode_float_##name
#else
typedef int16_t sample_t;
typedef antinode_fixed_t state_t;
#define CALL(name) antinode_fixed_##name
#endif

#define CHECK(condition)                                                         \
    do {                                                                         \
        if (!(condition)) {                                                      \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
            exit(1);                                                             \
        }                                                                        \
    } while (0)

enum { PAIRS = 4096 };

static sample_t samples[2 * PAIRS];
static uint32_t words[PAIRS];
static antinode_estimate_t estimate;
static antinode_health_t health;
static antinode_settings_t settings;
static size_t taken;

/* Checks that every function except _init returns `expected` on this state. */
static void all_answer(state_t *state, antinode_status_t expected)
{
    CHECK(CALL(reset)(state) == expected);
    CHECK(CALL(push)(state, 0, 0) == expected);
    CHECK(CALL(push_block)(state, samples, samples, PAIRS) == expected);
    CHECK(CALL(push_block_interleaved)(state, samples, PAIRS) == expected);
    CHECK(CALL(push_block_packed)(state, words, PAIRS) == expected);
    CHECK(CALL(skip)(state, 1) == expected);
    CHECK(CALL(solve)(state, &estimate) == expected);
    CHECK(CALL(search)(state) == expected);
    CHECK(CALL(set_calibration)(state, &settings.calibration) == expected);
    CHECK(CALL(health)(state, &health) == expected);
    CHECK(CALL(identify)(state, samples, PAIRS, &taken, &estimate) == expected);
}

static void bad_states(void)
{
    state_t *state = malloc(sizeof *state + 8);
    int byte;

    CHECK(state);
    all_answer(NULL, ANTINODE_ERROR_NULL);
    CHECK(CALL(init)(NULL, &settings) == ANTINODE_ERROR_NULL);
    for (byte = 0; byte < 256; byte++) {
        memset(state, byte, sizeof *state);
        all_answer(state, ANTINODE_ERROR_NOT_INITIALISED);
    }
    /* Through an integer: a misaligned pointer of this type must not even be formed from a pointer. */
    all_answer((state_t *)((uintptr_t)state + 1), ANTINODE_ERROR_ALIGNMENT);
    CHECK(CALL(init)((state_t *)((uintptr_t)state + 4), &settings) == ANTINODE_ERROR_ALIGNMENT);
    CHECK(CALL(init)(state, NULL) == ANTINODE_ERROR_NULL);
    CHECK(CALL(init)(state, (const antinode_settings_t *)((uintptr_t)&settings + 1)) == ANTINODE_ERROR_ALIGNMENT);
    free(state);
}

static void bad_arguments(state_t *state)
{
    const size_t absurd = SIZE_MAX;
    CHECK(CALL(init)(state, &settings) == ANTINODE_OK);
    CHECK(CALL(push_block)(state, NULL, samples, PAIRS) == ANTINODE_ERROR_NULL);
    CHECK(CALL(push_block)(state, samples, NULL, PAIRS) == ANTINODE_ERROR_NULL);
    CHECK(CALL(push_block)(state, samples, samples, absurd) == ANTINODE_ERROR_COUNT);
    CHECK(CALL(push_block_interleaved)(state, NULL, PAIRS) == ANTINODE_ERROR_NULL);
    CHECK(CALL(push_block_interleaved)(state, samples, absurd) == ANTINODE_ERROR_COUNT);
    CHECK(CALL(push_block_interleaved)(state, (const sample_t *)((uintptr_t)samples + 1), 2) == ANTINODE_ERROR_ALIGNMENT);
    CHECK(CALL(push_block_packed)(state, NULL, PAIRS) == ANTINODE_ERROR_NULL);
    CHECK(CALL(push_block_packed)(state, words, absurd / 2) == ANTINODE_ERROR_COUNT);
    CHECK(CALL(push_block_packed)(state, (const uint32_t *)((uintptr_t)words + 2), 2) == ANTINODE_ERROR_ALIGNMENT);
    CHECK(CALL(push_block_packed)(state, words, 0) == ANTINODE_OK);
    CHECK(CALL(solve)(state, NULL) == ANTINODE_ERROR_NULL);
    CHECK(CALL(solve)(state, (antinode_estimate_t *)((uintptr_t)&estimate + 1)) == ANTINODE_ERROR_ALIGNMENT);
    CHECK(CALL(set_calibration)(state, NULL) == ANTINODE_ERROR_NULL);
    CHECK(CALL(health)(state, NULL) == ANTINODE_ERROR_NULL);
    CHECK(CALL(identify)(state, NULL, PAIRS, &taken, &estimate) == ANTINODE_ERROR_NULL);
    CHECK(CALL(identify)(state, samples, PAIRS, NULL, &estimate) == ANTINODE_ERROR_NULL);
    CHECK(CALL(identify)(state, samples, PAIRS, &taken, NULL) == ANTINODE_ERROR_NULL);
    CHECK(CALL(identify)(state, samples, absurd, &taken, &estimate) == ANTINODE_ERROR_COUNT);
}

#define REFUSED(field, value, expected)                           \
    do {                                                          \
        antinode_settings_t wrong = settings;                     \
        wrong.field = value;                                      \
        CHECK(CALL(init)(state, &wrong) == expected);             \
        CHECK(CALL(push)(state, 0, 0) == ANTINODE_ERROR_NOT_INITIALISED); \
    } while (0)

static void bad_settings(state_t *state)
{
    const double rates[] = {0, -1, 0.5, 1e11, HUGE_VAL, -HUGE_VAL, nan("")};
    size_t i;
    for (i = 0; i < sizeof rates / sizeof rates[0]; i++)
        REFUSED(sample_rate_hz, rates[i], ANTINODE_ERROR_SAMPLE_RATE);
    REFUSED(periods, 0, ANTINODE_ERROR_PERIODS);
    REFUSED(periods, ANTINODE_MOST_PERIODS + 1, ANTINODE_ERROR_PERIODS);
    REFUSED(periods, 65536 + 10, ANTINODE_ERROR_PERIODS);
    REFUSED(hop_blocks, 65536, ANTINODE_ERROR_HOP);
    REFUSED(start_angle_rad, nanf(""), ANTINODE_ERROR_START_ANGLE);
    REFUSED(rail_low, HUGE_VALF, ANTINODE_ERROR_RAILS);
    REFUSED(rail_high, -1.0f, ANTINODE_ERROR_RAILS);
    REFUSED(resolution, nanf(""), ANTINODE_ERROR_RESOLUTION);
    REFUSED(frequency_hz, nanf(""), ANTINODE_ERROR_FREQUENCY);
    REFUSED(frequency_hz, -5332.0f, ANTINODE_ERROR_FREQUENCY);
    REFUSED(frequency_hz, 1e5f / 2.49f, ANTINODE_ERROR_FREQUENCY);
    REFUSED(frequency_hz, 1e5f / 201.0f, ANTINODE_ERROR_FREQUENCY);
    REFUSED(detection, UINT32_MAX, ANTINODE_ERROR_DETECTION);
    REFUSED(watch, 2, ANTINODE_ERROR_WATCH);
    REFUSED(hum, 2, ANTINODE_ERROR_HUM);
    REFUSED(coloured, 2, ANTINODE_ERROR_COLOURED);
    REFUSED(calibration.gain_ratio, 0, ANTINODE_ERROR_GAIN_RATIO);
    REFUSED(calibration.skew_s, HUGE_VALF, ANTINODE_ERROR_SKEW);
    REFUSED(calibration.pick_off_angle_rad, nanf(""), ANTINODE_ERROR_PICK_OFF_ANGLE);
}

/* Pushes any samples at all by every function; whatever they are, the states must remain usable. */
static void hard_samples(state_t *state, sample_t high, sample_t low, uint32_t detection, uint32_t periods, uint32_t watch)
{
    int round, i;
    antinode_settings_t hard = settings;
    hard.detection = detection;
    hard.periods = periods;
    hard.watch = watch;
    hard.hop_blocks = 1;
    CHECK(CALL(init)(state, &hard) == ANTINODE_OK);
    for (round = 0; round < 48; round++) {
        const int half = 2 + 7 * (round % 12);
        for (i = 0; i < PAIRS; i++) {
            samples[2 * i] = i / half % 2 ? high : low;
            samples[2 * i + 1] = round % 3 == 0 ? high : (i + half / 2) / half % 2 ? high : low;
            words[i] = round % 2 ? 0x80007fffu : (i / half % 2 ? 0x80008000u : 0x7fff7fffu);
        }
        CALL(push_block)(state, samples, samples + PAIRS, PAIRS);
        CALL(push_block_interleaved)(state, samples, PAIRS);
        CALL(push_block_packed)(state, words, PAIRS);
        CALL(push)(state, high, low);
        CALL(skip)(state, round == 40 ? UINT32_MAX : 3);
        CHECK(CALL(health)(state, &health) == ANTINODE_OK && health.waiting <= ANTINODE_QUEUE_BLOCKS);
        while (CALL(solve)(state, &estimate) == ANTINODE_ESTIMATE)
            CHECK(estimate.flags < 0x200 && estimate.reserved == 0);
        CHECK(CALL(identify)(state, samples, PAIRS, &taken, &estimate) >= 0 && taken <= PAIRS);
        if (round % 16 == 15)
            CHECK(CALL(search)(state) == ANTINODE_OK);
        if (round % 20 == 19)
            CHECK(CALL(set_calibration)(state, &settings.calibration) == ANTINODE_OK);
    }
    CHECK(CALL(reset)(state) == ANTINODE_OK);
}

int main(void)
{
    /* On the heap, so that a write beyond its end is detected. */
    state_t *state = malloc(sizeof *state);
    int i;

    CHECK(state);
    settings = antinode_settings_default(100e3);
    for (i = -40; i < 10; i++)
        CHECK(strlen(antinode_status_string(i)) > 3);
    CHECK(strcmp(antinode_status_string(INT32_MIN), "unknown status") == 0);
    CHECK(antinode_version() == ANTINODE_HEADER_VERSION);
    CHECK(antinode_fixed_size() == sizeof(antinode_fixed_t) && antinode_float_size() == sizeof(antinode_float_t));
    bad_states();
    bad_arguments(state);
    bad_settings(state);
#if defined(FLOAT)
    hard_samples(state, 3e38f, -3e38f, ANTINODE_DETECTION_DIFFERENCE, 2, 1);
    hard_samples(state, HUGE_VALF, nanf(""), ANTINODE_DETECTION_MEAN_RETURN, 10, 1);
    hard_samples(state, 1e-38f, 0.0f, ANTINODE_DETECTION_DIFFERENCE, 10, 0);
#endif
    hard_samples(state, 32767, -32768, ANTINODE_DETECTION_DIFFERENCE, 2, 1);
    hard_samples(state, 32767, -32768, ANTINODE_DETECTION_MEAN_RETURN, 10, 1);
    hard_samples(state, 32767, 32766, ANTINODE_DETECTION_DIFFERENCE, ANTINODE_MOST_PERIODS, 0);
    free(state);
    printf("every function stood\n");
    return 0;
}
