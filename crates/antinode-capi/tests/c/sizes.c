/* Prints the sizes that the ABI fixes, the same on every machine, as README.md's table. */
#include <stdio.h>

#include "antinode.h"

#define ROW(type) printf("| `%s` | %u |\n", #type, (unsigned)sizeof(type))

int main(void)
{
    printf("| type | bytes |\n|---|---|\n");
    ROW(antinode_fixed_t);
    ROW(antinode_float_t);
    ROW(antinode_settings_t);
    ROW(antinode_calibration_t);
    ROW(antinode_estimate_t);
    ROW(antinode_health_t);
    ROW(antinode_status_t);
    return 0;
}
