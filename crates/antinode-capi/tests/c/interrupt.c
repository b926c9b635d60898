/*
 * An interrupt pushes half-buffers at random phases while the thread solves: wherever it breaks in, and whatever is lost, every estimate
 * is right or flagged. SysTick is the interrupt, in QEMU with -icount shift=0,align=off,sleep=off.
 */
#include <math.h>
#include <string.h>

#include "counts.h"

void SysTick_Handler(void);

static state_t gyro, other;
static uint32_t codes[HALF_BUFFER];
static antinode_estimate_t estimate;
static volatile uint32_t left, refused, dropping, most_ticks = 40000;
static uint32_t at, lost, windows, clean, wrong;
static int is_told;

static uint32_t random_below(uint32_t bound)
{
    static uint32_t seed = 1;
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) % bound;
}

void SysTick_Handler(void)
{
    antinode_status_t status;
    uint32_t i;
    if (left == 0)
        return;
    left--;
    SYSTICK[1] = most_ticks / 2 + random_below(most_ticks / 2);
    /* One interrupt in twenty comes too late, after the loss of a half-buffer. */
    if (lost != 0 && left % 20 == 0) {
        at += lost;
        if (is_told)
            CALL(skip)(&gyro, lost);
    }
    for (i = 0; i < HALF_BUFFER; i++)
        codes[i] = _binary_codes_bin_start[at++ % RING];
    status = CALL(push_block_packed)(&gyro, codes, HALF_BUFFER);
    if (status == ANTINODE_ERROR_NOT_INITIALISED)
        refused++;
    else if (status == ANTINODE_DROPPED)
        dropping++;
    CALL(push_block_packed)(&other, codes, HALF_BUFFER);
}

/* Lets the interrupt come `times` times from now on. */
static void start(uint32_t times)
{
    SYSTICK[1] = most_ticks;
    SYSTICK[2] = 0;
    left = times;
    SYSTICK[0] = 7; /* on, at the core's clock, with its interrupt */
}

/* Solves the queued blocks, and compares clean estimates with the wave of the codes, 75 periods a ring. */
static void solve(void)
{
    while (CALL(solve)(&gyro, &estimate) == ANTINODE_ESTIMATE) {
        windows++;
        if (estimate.flags != 0)
            continue;
        clean++;
        wrong += !(fabs(estimate.angle_rad - 0.5236) < 1e-3 && fabs(estimate.frequency_hz - 75e5 / RING) < 0.5 &&
                   fabsf(estimate.main_amplitude - 1599) < 2 && fabsf(estimate.quadrature_amplitude - 80) < 2);
    }
}

/* Prints and clears the counts of windows; returns 1 if an estimate was wrong, or too few or too many were clean. */
static int failed(const char *what, uint32_t most_clean)
{
    const int is = wrong != 0 || clean < 100 || clean > most_clean;
    printf("%s %s: %lu windows, %lu without a flag, %lu of them wrong\n", NAME, what, (unsigned long)windows, (unsigned long)clean,
           (unsigned long)wrong);
    windows = clean = wrong = 0;
    return is;
}

int main(void)
{
    const antinode_settings_t settings = antinode_settings_default(100e3);
    antinode_estimate_t same;
    uint32_t i, stall;
    int bad = 0;

    /* Two gyros, with interrupts at any phase of the thread. */
    bad |= CALL(init)(&gyro, &settings) != ANTINODE_OK || CALL(init)(&other, &settings) != ANTINODE_OK;
    for (start(600); left != 0;) {
        const uint32_t before = windows;
        solve();
        while (before != windows && CALL(solve)(&other, &same) == ANTINODE_ESTIMATE && same.start != estimate.start)
            ;
        bad |= before != windows && memcmp(&same, &estimate, sizeof same) != 0;
    }
    bad |= failed("at any phase", UINT32_MAX);

    /* The thread stalls for a tenth of a second and more, and goes on. */
    for (i = 0, start(1000); left != 0;) {
        solve();
        if (windows >= i + 40)
            for (i = windows, stall = left; left != 0 && stall - left < 100;)
                ;
    }
    bad |= dropping == 0;
    bad |= failed("with stalls", UINT32_MAX);

    /* Half-buffers are lost, with and without a _skip. */
    lost = HALF_BUFFER;
    for (is_told = 0; is_told < 2; is_told++) {
        CALL(reset)(&gyro);
        for (start(800); left != 0;)
            solve();
        bad |= failed(is_told ? "with told losses" : "with losses", is_told ? UINT32_MAX : windows - 40);
    }
    lost = 0;

    /* The interrupt breaks into initialisation and reset again and again. */
    for (i = 0; i < 120; i++) {
        uint32_t again;
        most_ticks = 600 + 13 * i;
        start(60);
        for (again = 0; again < 6; again++)
            if ((i & 1) != 0)
                CALL(init)(&gyro, &settings);
            else
                CALL(reset)(&gyro);
        most_ticks = 40000;
        while (left != 0)
            solve();
    }
    bad |= refused == 0;
    printf("%s refused %lu\n", NAME, (unsigned long)refused);
    bad |= failed("in initialisation", UINT32_MAX);
    return bad;
}
