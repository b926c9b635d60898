/*
 * Reads a 16-bit stereo WAV recording (left S_C, right S_D) and prints the wave, one CSV row a window: the rows of
 * `antinode identify --output csv`, if a period has at most 100 samples: with more that cuts its windows otherwise.
 *
 *     host recording.wav
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "antinode.h"

enum { PAIRS_AT_ONCE = 4096 };

static antinode_float_t gyro;

static unsigned long little(const unsigned char *bytes, int count)
{
    unsigned long value = 0;
    while (count-- > 0)
        value = value << 8 | bytes[count];
    return value;
}

/* Finds the samples of a WAV file; returns their length in bytes and sets the sample rate, or returns 0 if it is no such file. */
static unsigned long open_wav(FILE *file, double *sample_rate_hz)
{
    unsigned char head[16];
    int known = 0;

    if (fread(head, 1, 12, file) != 12 || memcmp(head, "RIFF", 4) != 0 || memcmp(head + 8, "WAVE", 4) != 0)
        return 0;
    while (fread(head, 1, 8, file) == 8) {
        const unsigned long size = little(head + 4, 4);
        unsigned long read = 0;
        if (memcmp(head, "data", 4) == 0)
            return known ? size : 0;
        if (memcmp(head, "fmt ", 4) == 0) {
            if (size < 16 || fread(head, 1, 16, file) != 16)
                return 0;
            known = little(head + 2, 2) == 2 && little(head + 14, 2) == 16;
            *sample_rate_hz = (double)little(head + 4, 4);
            read = 16;
        }
        if (fseek(file, (long)(size - read + (size & 1)), SEEK_CUR) != 0)
            return 0;
    }
    return 0;
}

static void print_flags(uint32_t flags)
{
    static const char *const names[] = {"clipped", "lost",         "phase_jump", "step",      "circular",
                                        "misfit",  "dead_channel", "reacquired", "not_finite"};
    const char *join = "";
    size_t bit;
    for (bit = 0; bit < sizeof names / sizeof names[0]; bit++) {
        if (flags >> bit & 1) {
            printf("%s%s", join, names[bit]);
            join = "+";
        }
    }
}

static void print_row(const antinode_estimate_t *e, const char *name)
{
    printf("%.17g,%lu,%.9g,%.9g,%.17g,%.9g,%.17g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,", round(e->time_s * 1e12) / 1e12,
           (unsigned long)e->samples, (double)e->main_amplitude, (double)e->quadrature_amplitude, round(e->angle_rad * 1e9) / 1e9, (double)e->phase_rad,
           round(e->frequency_hz * 1e9) / 1e9, (double)e->angle_rate_rad_s, (double)e->decay_rate_s,
           (double)e->main_amplitude_std, (double)e->quadrature_amplitude_std, (double)e->angle_std_rad,
           (double)e->frequency_std_hz, (double)e->residual_rms);
    print_flags(e->flags);
    printf(",%.9g,%.9g,%.9g,%.9g,%.9g,%s\n", (double)e->offset_c, (double)e->offset_d, (double)e->phase_std_rad,
           (double)e->angle_rate_std_rad_s, (double)e->decay_rate_std_s, name);
}

int main(int argc, char **argv)
{
    static unsigned char bytes[4 * PAIRS_AT_ONCE];
    static float samples[2 * PAIRS_AT_ONCE];
    double sample_rate_hz = 0;
    antinode_settings_t settings;
    antinode_status_t status;
    unsigned long left;
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;

    if (!file) {
        fprintf(stderr, "usage: %s RECORDING.wav\n", argv[0]);
        return 2;
    }
    left = open_wav(file, &sample_rate_hz);
    if (left == 0) {
        fprintf(stderr, "%s: not a 16-bit stereo WAV file\n", argv[1]);
        return 1;
    }

    if (antinode_version() >> 8 != ANTINODE_HEADER_VERSION >> 8 || antinode_float_size() != sizeof gyro) {
        fprintf(stderr, "this is not the header of the library that is loaded\n");
        return 1;
    }
    /* Samples are scaled so that full scale is 1; the largest code lies one step below it. */
    settings = antinode_settings_default(sample_rate_hz);
    settings.resolution = 1.0f / 32768.0f;
    settings.rail_high = 32767.0f / 32768.0f;
    settings.rail_low = -settings.rail_high;
    status = antinode_float_init(&gyro, &settings);
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", argv[1], antinode_status_string(status));
        return 1;
    }

    printf("time_s,samples,main_amplitude,quadrature_amplitude,angle_rad,phase_rad,frequency_hz,angle_rate_rad_s,decay_rate_s,"
           "main_amplitude_std,quadrature_amplitude_std,angle_std_rad,frequency_std_hz,residual_rms,flags,offset_c,offset_d,"
           "phase_std_rad,angle_rate_std_rad_s,decay_rate_std_s,file\n");
    while (left >= 4) {
        const size_t wanted = left / 4 < PAIRS_AT_ONCE ? left / 4 : PAIRS_AT_ONCE;
        const size_t count = fread(bytes, 4, wanted, file);
        size_t i, at = 0;
        if (count == 0)
            break;
        left -= 4 * (unsigned long)count;
        for (i = 0; i < 2 * count; i++) {
            const long code = (long)little(bytes + 2 * i, 2);
            samples[i] = (float)(code < 32768 ? code : code - 65536) / 32768.0f;
        }
        while (at < count) {
            antinode_estimate_t estimate;
            size_t taken;
            status = antinode_float_identify(&gyro, samples + 2 * at, count - at, &taken, &estimate);
            if (status < 0) {
                fprintf(stderr, "%s: %s\n", argv[1], antinode_status_string(status));
                return 1;
            }
            at += taken;
            if (status == ANTINODE_ESTIMATE)
                print_row(&estimate, argv[1]);
        }
    }
    fclose(file);
    return 0;
}
