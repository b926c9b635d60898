/* The header in C, for a compiler with every warning that other projects turn on. */
#include "antinode.h"

extern uint32_t beside(const antinode_estimate_t *estimate);
extern int is_ours(void);

uint32_t beside(const antinode_estimate_t *estimate)
{
    return estimate->flags & ~ANTINODE_FLAG_REACQUIRED;
}

int is_ours(void)
{
    return antinode_version() == ANTINODE_HEADER_VERSION;
}
