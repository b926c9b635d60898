/* Vector table and reset: turns the FPU on, if there is one, and calls newlib's start-up, which exits through semihosting after main. */
#include <stdint.h>

extern uint32_t stack_top[];
void _start(void);
void reset(void);

void reset(void)
{
#if defined(__ARM_FP)
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* CPACR: full access to CP10 and CP11 */
    __asm volatile("dsb\n isb");
#endif
    _start();
}

static void stop(void)
{
    for (;;)
        ;
}

/* Replaced by the program's own handler, if it has one. */
void SysTick_Handler(void) __attribute__((weak, alias("stop")));

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*handlers[15])(void);
} vectors = {
    stack_top,
    {reset, stop, stop, stop, stop, stop, stop, stop, stop, stop, stop, stop, stop, stop, SysTick_Handler},
};
