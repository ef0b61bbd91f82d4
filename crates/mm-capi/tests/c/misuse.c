/*
 * Law: a call that is wrong returns the status that says so and leaves outputs and controller as they were; a call that is right gives
 * the torque that holds the arm.
 *
 * Reference: the bytes before the call, and the weight of the arm by hand. Exact but for the weight (1e-9 of it in double precision,
 * 1e-4 in single). Runs plainly, under valgrind and with sanitizers: what is not initialised, out of bounds or misaligned shows there.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mm_control.h"

static int failures;

static void expect(int holds, const char *what, int line)
{
    if (!holds) {
        printf("misuse.c:%d: %s\n", line, what);
        failures++;
    }
}

#define EXPECT(condition) expect((condition) ? 1 : 0, #condition, __LINE__)

/* With an argument memory of controllers is not compared: valgrind does not like to see the gaps in it read. */
static int memory_is_compared;

static int same_memory(const void *a, const void *b, size_t size)
{
    return !memory_is_compared || memcmp(a, b, size) == 0;
}

#define real double
#define MM(name) mm_##name
#define RUN run_double
#define TOLERANCE 1e-9
#include "misuse.inc"
#undef real
#undef MM
#undef RUN
#undef TOLERANCE

#define real float
#define MM(name) mmf_##name
#define RUN run_float
#define TOLERANCE 1e-4
#include "misuse.inc"

static void texts(void)
{
    static const int32_t known[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 16, 17, 18, 19, 20, 32, 33, 34, 35, 36, 37, 38, 39};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        EXPECT(strcmp(mm_status_text(known[i]), "no such status") != 0);
        for (size_t j = 0; j < i; j++) {
            EXPECT(strcmp(mm_status_text(known[i]), mm_status_text(known[j])) != 0);
        }
    }
    EXPECT(strcmp(mm_status_text(-1), "no such status") == 0);
    EXPECT(strcmp(mm_status_text(9), "no such status") == 0);
    EXPECT(mm_abi_version() == MM_ABI_VERSION);
    EXPECT(strchr(mm_version(), '.') != NULL);
}

int main(int count, char **arguments)
{
    (void)arguments;
    memory_is_compared = count == 1;
    texts();
    run_double();
    run_float();
    if (failures != 0) {
        printf("%d failures\n", failures);
    }
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
