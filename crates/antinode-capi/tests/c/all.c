/* Calls every function of one arithmetic, or none with -DNONE: the difference is the flash that the library takes. */
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

state_t state;
antinode_settings_t settings;
antinode_estimate_t estimate;
antinode_health_t health;
sample_t samples[256];
uint32_t words[128];
size_t taken;
volatile int32_t sink;
const char *volatile text;

int main(void)
{
#ifndef NONE
    settings = antinode_settings_default(1e5);
    sink = CALL(init)(&state, &settings);
    sink = CALL(push)(&state, samples[0], samples[1]);
    sink = CALL(push_block)(&state, samples, samples + 128, 128);
    sink = CALL(push_block_interleaved)(&state, samples, 128);
    sink = CALL(push_block_packed)(&state, words, 128);
    sink = CALL(skip)(&state, 1);
    sink = CALL(solve)(&state, &estimate);
    sink = CALL(search)(&state);
    sink = CALL(set_calibration)(&state, &settings.calibration);
    sink = CALL(health)(&state, &health);
    sink = CALL(identify)(&state, samples, 128, &taken, &estimate);
    sink = CALL(reset)(&state);
    text = antinode_status_string(sink);
    sink = (int32_t)antinode_version();
    sink = (int32_t)CALL(size)();
#endif
    return 0;
}
