/*
 * Identification on a bare Cortex-M: half-buffers of packed codes, as a converter's DMA leaves them, are pushed as its interrupt would, and
 * windows solved as a thread would. Prints one line a window through semihosting, every number as its bits: the Rust core on a PC
 * (examples/reference.rs) prints the same.
 *
 * Make it with -DFLOAT for single precision; the default is fixed point.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "antinode.h"

#if defined(FLOAT)
#define STATE antinode_float_t
#define CALL(name) antinode_float_##name
#else
#define STATE antinode_fixed_t
#define CALL(name) antinode_fixed_##name
#endif

enum { RING = 1406, HALF_BUFFER = 128, PAIRS = 20000 };

/* One ring of codes, repeated without end: codes.bin, which the Makefile links into the image. */
extern const uint32_t _binary_codes_bin_start[RING];

static STATE gyro;

static void print_bits(const antinode_estimate_t *e)
{
    const double doubles[] = {e->time_s, e->angle_rad, e->frequency_hz};
    const float floats[] = {
        e->main_amplitude,     e->quadrature_amplitude, e->phase_rad,        e->angle_rate_rad_s,         e->decay_rate_s,
        e->offset_c,           e->offset_d,             e->main_amplitude_std, e->quadrature_amplitude_std, e->angle_std_rad,
        e->phase_std_rad,      e->frequency_std_hz,     e->angle_rate_std_rad_s, e->decay_rate_std_s,     e->residual_rms,
    };
    size_t i;

    printf("%08" PRIx32 "%08" PRIx32, (uint32_t)(e->start >> 32), (uint32_t)e->start);
    for (i = 0; i < sizeof doubles / sizeof doubles[0]; i++) {
        uint64_t bits;
        memcpy(&bits, &doubles[i], sizeof bits);
        printf(" %08" PRIx32 "%08" PRIx32, (uint32_t)(bits >> 32), (uint32_t)bits);
    }
    printf(" %" PRIu32 " %03" PRIx32, e->samples, e->flags);
    for (i = 0; i < sizeof floats / sizeof floats[0]; i++) {
        uint32_t bits;
        memcpy(&bits, &floats[i], sizeof bits);
        printf(" %08" PRIx32, bits);
    }
    printf("\n");
}

int main(void)
{
    antinode_settings_t settings;
    antinode_status_t status;
    antinode_estimate_t estimate;
    size_t at = 0;

    if (antinode_version() >> 8 != ANTINODE_HEADER_VERSION >> 8 || CALL(size)() != sizeof gyro) {
        printf("this is not the header of the library that is linked\n");
        return 1;
    }
    settings = antinode_settings_default(100e3);
    status = CALL(init)(&gyro, &settings);
    if (status != ANTINODE_OK) {
        printf("init: %s\n", antinode_status_string(status));
        return 1;
    }
    while (at < PAIRS) {
        const size_t from = at % RING;
        size_t count = PAIRS - at < HALF_BUFFER ? PAIRS - at : HALF_BUFFER;
        if (count > RING - from)
            count = RING - from;

        /* In the interrupt of the converter's DMA: */
        status = CALL(push_block_packed)(&gyro, _binary_codes_bin_start + from, count);
        at += count;
        if (status < 0 || status == ANTINODE_DROPPED)
            printf("push: %s\n", antinode_status_string(status));

        /* In the thread: */
        while (CALL(solve)(&gyro, &estimate) == ANTINODE_ESTIMATE)
            print_bits(&estimate);
    }
    return 0;
}
