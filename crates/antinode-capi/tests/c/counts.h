/* Common to the programs that count costs: the arithmetic they are built for, the codes, a clock, and a gauge of the stack. */
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

/* Sample pairs of the ring of codes, of a measurement, and of a half-buffer. */
enum { RING = 1406, PAIRS = 16384, HALF_BUFFER = 128 };
extern const uint32_t _binary_codes_bin_start[RING];

/* How many pairs to push next at pair `at` of the endless stream: a half-buffer, but not beyond `to` or the ring's end. */
static inline uint32_t next_pairs(uint32_t at, uint32_t to)
{
    const uint32_t left = RING - at % RING, count = to - at < HALF_BUFFER ? to - at : HALF_BUFFER;
    return count < left ? count : left;
}

#define SYSTICK ((volatile uint32_t *)0xE000E010u)
/* Ticks of it in a thousand instructions, which take 1 ns each: 168 MHz on netduinoplus2, 20 on the Cortex-M33 of mps2-an505. */
#if defined(__ARM_ARCH) && __ARM_ARCH >= 8
enum { MHZ = 20 };
#else
enum { MHZ = 168 };
#endif
static inline uint32_t now(void) { return SYSTICK[2]; }

/* Words painted below the stack pointer: more than any call takes. */
enum { PAINTED = 2560 };
static const uint32_t PAINT = 0x5afe5afeu;

/* Paints the words below the stack pointer, and returns the stack pointer. */
static inline __attribute__((always_inline)) volatile uint32_t *paint_stack(void)
{
    volatile uint32_t *top, *word;
    __asm volatile("mov %0, sp" : "=r"(top));
    for (word = top - PAINTED; word < top; word++)
        *word = PAINT;
    return top;
}

/* Bytes from `top` down to the lowest word whose paint is gone: the stack that was taken. */
static inline __attribute__((always_inline)) uint32_t stack_taken(volatile uint32_t *top)
{
    volatile uint32_t *word;
    for (word = top - PAINTED; word < top && *word == PAINT; word++)
        ;
    return (uint32_t)(top - word) * 4;
}

#endif
