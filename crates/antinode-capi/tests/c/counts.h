/* What the counts on a Cortex-M4 share: the arithmetic they are built for, and ticks. */
#ifndef COUNTS_H
#define COUNTS_H

#include <stdio.h>

#include "antinode.h"

#if defined(FLOAT)
typedef float sample_t;
typedef antinode_float_t state_t;
#define CALL(name) antinode_float_##name
#define NAME "float"
#else
typedef int16_t sample_t;
typedef antinode_fixed_t state_t;
#define CALL(name) antinode_fixed_##name
#define NAME "fixed"
#endif

#define SYSTICK ((volatile uint32_t *)0xE000E010u)
static uint32_t now(void) { return SYSTICK[2]; }

#endif
