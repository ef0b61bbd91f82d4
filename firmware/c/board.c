/*
 * The ticks on a Cortex-M under QEMU or a debugger: start, semihosting, painted stack. All that knows the machine is here and in
 * board.ld; for another one, exchange say() and finish().
 */
#include <stdint.h>

#include "ticks.h"

extern uint32_t stack_top, stack_limit, data_start, data_end, data_source, bss_start, bss_end;

#define PAINT UINT32_C(0x5aa55aa5)

/* A call of the debugger; QEMU answers it. */
static void semihosting(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void say(const char *text)
{
    semihosting(0x04, text);
}

static void finish(int bad)
{
    semihosting(0x18, (const void *)(uintptr_t)(bad ? 0x20023 : 0x20026));
    for (;;) {
    }
}

/* Paints what lies below the stack pointer and counts what was overwritten since the last time. */
__attribute__((noinline)) unsigned long stack_used(void)
{
    uintptr_t here, at = (uintptr_t)&stack_limit;
    __asm__ volatile("mov %0, sp" : "=r"(here));
    while (at < here && *(volatile uint32_t *)at == PAINT) {
        at += 4;
    }
    unsigned long used = (unsigned long)(here - at);
    for (at = (uintptr_t)&stack_limit; at < here; at += 4) {
        *(volatile uint32_t *)at = PAINT;
    }
    return used;
}

static void fault(void)
{
    say("fault\n");
    finish(1);
}

void reset(void)
{
    uint32_t *source = &data_source;
    for (uint32_t *to = &data_start; to < &data_end;) {
        *to++ = *source++;
    }
    for (uint32_t *to = &bss_start; to < &bss_end;) {
        *to++ = 0;
    }
#if defined(__ARM_FP)
    /* The floating-point unit is off at first. */
    *(volatile uint32_t *)0xe000ed88 |= UINT32_C(0xf) << 20;
    __asm__ volatile("dsb\n isb");
#endif
    finish(ticks());
}

typedef void (*handler)(void);

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    handler handlers[15];
} vectors = {&stack_top, {reset, fault, fault, fault, fault, fault, 0, 0, 0, 0, fault, 0, 0, fault, fault}};
