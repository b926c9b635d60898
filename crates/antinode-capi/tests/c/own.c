/* A program that calls memory, string and mathematical functions beside the library's: `check` sees where the linker found each. */
#include <math.h>
#include <string.h>

#include "antinode.h"

volatile double x = 2;
volatile size_t size = 4;
volatile uint64_t wide = 1000;
volatile int32_t sink;
char to[16], from[16] = "text";
antinode_float_t state;

#if defined(__arm__)
/* Functions that a compiler calls to assign structs. */
void __aeabi_memcpy(void *, const void *, size_t);
void __aeabi_memcpy4(void *, const void *, size_t);
#endif

int main(void)
{
    const antinode_settings_t settings = antinode_settings_default(x * 1e5);

    sink = antinode_float_init(&state, &settings);
    memcpy(to, from, size);
    memmove(to + 1, to, size);
    memset(to, 0, size);
#if defined(__arm__)
    __aeabi_memcpy(to, from, size);
    __aeabi_memcpy4(to, from, size);
#endif
    sink = memcmp(to, from, size) + (int32_t)strlen(from);
    sink = (int32_t)(wide / (uint64_t)sink);
    x = sin(x) + cos(x) * (double)sinf((float)x) + pow(x, x) + sqrt(x) + cbrt(x) + fma(x, x, x) + fmod(x, x) + floor(x);
    return (int)(x / 3);
}
