// The header in C++11: sizes, linkage, and the enum as a number.
#include "antinode.h"

#include <cstdio>

static_assert(sizeof(antinode_fixed_t) == 8u * ANTINODE_FIXED_WORDS, "opaque words only");
static_assert(alignof(antinode_float_t) == 8, "64-bit words");
static_assert(sizeof(antinode_status_t) == 4, "the same with and without -fshort-enums");

int main()
{
    static antinode_float_t state;
    const antinode_settings_t settings = antinode_settings_default(100e3);
    const antinode_status_t status = antinode_float_init(&state, &settings);
    std::printf("%s\n", antinode_status_string(status));
    return status == ANTINODE_OK && antinode_version() == ANTINODE_HEADER_VERSION ? 0 : 1;
}
