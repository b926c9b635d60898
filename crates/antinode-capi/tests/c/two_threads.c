/* One thread pushes as an interrupt would, another solves: the estimates are those of one thread alone. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>

#include "antinode.h"

enum { PAIRS = 400000, MOST = 4000 };

static antinode_fixed_t gyro;
static int16_t samples[2 * PAIRS];
static antinode_estimate_t alone[MOST], shared[MOST];
static size_t taken_alone, taken_shared;
static int finished;
static pthread_mutex_t end = PTHREAD_MUTEX_INITIALIZER;

static int is_finished(void)
{
    int is;
    pthread_mutex_lock(&end);
    is = finished;
    pthread_mutex_unlock(&end);
    return is;
}

static void *interrupt(void *unused)
{
    size_t at;
    (void)unused;
    for (at = 0; at < PAIRS; at += 16) {
        antinode_health_t health;
        /* A converter would not wait; here no block may be dropped, so that results can be compared. */
        while (antinode_fixed_health(&gyro, &health) == ANTINODE_OK && health.waiting > ANTINODE_QUEUE_BLOCKS / 2)
            sched_yield();
        if (antinode_fixed_push_block_interleaved(&gyro, samples + 2 * at, 16) < 0)
            break;
    }
    pthread_mutex_lock(&end);
    finished = 1;
    pthread_mutex_unlock(&end);
    return NULL;
}

int main(void)
{
    const antinode_settings_t settings = antinode_settings_default(100e3);
    antinode_health_t health;
    pthread_t thread;
    size_t i, at = 0, taken;
    int last;

    for (i = 0; i < PAIRS; i++) {
        const double t = 2 * 3.14159265358979 * 5332.0 / 1e5 * (double)i;
        samples[2 * i] = (int16_t)lround(9000 * cos(t) - 300 * sin(t));
        samples[2 * i + 1] = (int16_t)lround(12000 * cos(t) + 200 * sin(t));
    }
    antinode_fixed_init(&gyro, &settings);
    while (at < PAIRS) {
        if (antinode_fixed_identify(&gyro, samples + 2 * at, PAIRS - at, &taken, &alone[taken_alone]) == ANTINODE_ESTIMATE)
            taken_alone++;
        at += taken;
    }

    antinode_fixed_reset(&gyro);
    if (pthread_create(&thread, NULL, interrupt, NULL) != 0)
        return 1;
    do {
        last = is_finished();
        while (taken_shared < MOST && antinode_fixed_solve(&gyro, &shared[taken_shared]) == ANTINODE_ESTIMATE)
            taken_shared++;
    } while (!last);
    pthread_join(thread, NULL);
    antinode_fixed_health(&gyro, &health);

    printf("%u and %u windows, %u blocks dropped\n", (unsigned)taken_alone, (unsigned)taken_shared, (unsigned)health.dropped);
    return taken_alone < 1000 || taken_alone != taken_shared || health.dropped != 0 ||
           memcmp(alone, shared, taken_alone * sizeof alone[0]) != 0;
}
