/*
 * A table of states through the controller, tick by tick: the outputs' bits as a checksum a line, the same on every machine.
 *
 * TICKS_FLOAT takes the functions in single precision, else those in double precision. Inputs are whole numbers over powers of two, so
 * that no compiler rounds them.
 */
#include "ticks.h"

#include <string.h>

#include "mm_control.h"

#ifdef TICKS_FLOAT
typedef float real;
#define MM(name) mmf_##name
#else
typedef double real;
#define MM(name) mm_##name
#endif

#define TICKS 40

static MM(controller) controller;
static MM(params) params;

/* FNV-1a over the bits. */
static uint64_t hashed(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * UINT64_C(0x100000001b3);
    }
    return hash;
}

static const uint64_t START = UINT64_C(0xcbf29ce484222325);

static void say_number(unsigned long number)
{
    char text[12];
    size_t at = sizeof text - 1;
    text[at] = '\0';
    do {
        text[--at] = (char)('0' + number % 10);
        number /= 10;
    } while (number != 0);
    say(&text[at]);
}

static void say_tick(const char *name, unsigned tick, uint64_t hash)
{
    char text[18];
    for (unsigned i = 0; i < 16; i++) {
        text[i] = "0123456789abcdef"[(hash >> (60 - 4 * i)) & 15];
    }
    text[16] = '\n';
    text[17] = '\0';
    say(name);
    say(" tick ");
    say_number(tick);
    say(" ");
    say(text);
}

static void say_stack(const char *what)
{
    unsigned long used = stack_used();
    if (used != 0) {
        say("# stack ");
        say(what);
        say(" ");
        say_number(used);
        say("\n");
    }
}

static int said(const char *what, mm_status status)
{
    if (status != MM_STATUS_OK) {
        say(what);
        say(": ");
        say(mm_status_text(status));
        say("\n");
    }
    return status != MM_STATUS_OK;
}

/* Between -1/8 and 1/8 in 2^16 steps. */
static real next(uint32_t *seed)
{
    *seed = *seed * UINT32_C(1664525) + UINT32_C(1013904223);
    return (real)((int32_t)(*seed >> 16) - 32768) / (real)262144;
}

static void fill(MM(input) *input, uint32_t *seed)
{
    MM(configuration) *q = &input->configuration;
    q->x_m = next(seed);
    q->y_m = next(seed);
    q->heading_rad = next(seed);
    for (int i = 0; i < MM_JOINTS; i++) {
        q->joints_rad[i] = params.robot.rest_posture_rad[i] + next(seed);
        input->velocity.joints_rad_s[i] = next(seed);
    }
    input->velocity.forward_m_s = next(seed);
    input->velocity.yaw_rate_rad_s = next(seed);
    for (int i = 0; i < 3; i++) {
        input->reference.position_m[i] = (i == 1 ? (real)0 : (real)0.5) + next(seed);
        input->reference.velocity_m_s[i] = next(seed);
        input->reference.acceleration_m_s2[i] = next(seed);
    }
}

static int begin(int32_t law, int32_t engine, int32_t estimator, uint32_t supervised)
{
    mm_problem problem;
    int bad = said("thesis", MM(params_thesis)(&params));
    params.law = law;
    bad |= said("defaults", MM(params_defaults)(&params, &problem));
    params.fuzzy_engine = engine;
    params.estimator.kind = estimator;
    params.supervised = supervised;
    mm_status status = MM(controller_init)(&controller, sizeof controller, MM_ABI_VERSION, &params, &problem);
    if (status != MM_STATUS_OK) {
        say(problem.parameter);
    }
    return bad | said(" init", status);
}

/* A law from configuration and velocity. */
static int updates(const char *name, int32_t law, int32_t engine)
{
    int bad = begin(law, engine, MM_ESTIMATOR_KIND_NONE, 0);
    uint32_t seed = 1;
    for (unsigned tick = 0; tick < TICKS; tick++) {
        MM(input) input;
        MM(output) output;
        MM(signals) signals;
        fill(&input, &seed);
        bad |= said(name, MM(controller_update)(&controller, &input, &output, &signals));
        uint64_t hash = hashed(START, &output.torque, sizeof output.torque);
        hash = hashed(hash, &output.flags, sizeof output.flags);
        say_tick(name, tick, hashed(hash, &signals, sizeof signals));
    }
    return bad;
}

/* From measured positions, with and without encoders of the wheels. */
static int measured(const char *name, int32_t estimator)
{
    int bad = begin(MM_LAW_BFSMC, MM_FUZZY_ENGINE_DEFAULT, estimator, 0);
    uint32_t seed = 2;
    for (unsigned tick = 0; tick < TICKS; tick++) {
        MM(input) input;
        MM(measurement) measurement;
        MM(output) output;
        MM(signals) signals;
        fill(&input, &seed);
        measurement.configuration = input.configuration;
        measurement.reference = input.reference;
        measurement.has_wheels = tick / 10 % 2;
        measurement.right_wheel_rad = next(&seed);
        measurement.left_wheel_rad = next(&seed);
        bad |= said(name, MM(controller_update_measured)(&controller, &measurement, &output, &signals));
        uint64_t hash = hashed(START, &output.torque, sizeof output.torque);
        say_tick(name, tick, hashed(hash, &signals, sizeof signals));
    }
    return bad;
}

/* Under the supervisor: an input that is no number, one that is missing, one that is late, and the way back. */
static int supervised(const char *name)
{
    int bad = begin(MM_LAW_BFSMC, MM_FUZZY_ENGINE_DEFAULT, MM_ESTIMATOR_KIND_NONE, 1);
    uint32_t seed = 3;
    MM(input) input;
    fill(&input, &seed);
    memset(&input.velocity, 0, sizeof input.velocity);
    for (unsigned tick = 0; tick < TICKS; tick++) {
        MM(timing) timing = {params.period_s, (real)0};
        MM(input) given = input;
        MM(command) command;
        MM(signals) signals;
        memset(&signals, 0, sizeof signals);
        mm_status status;
        if (tick == 10) {
            /* All bits set: not a number in either precision. */
            memset(&given.configuration.x_m, 0xff, sizeof given.configuration.x_m);
        }
        if (tick == 15) {
            timing.elapsed_s = (real)1;
        }
        if (tick >= 20 && tick < 25) {
            status = MM(controller_missed)(&controller, &timing, &command);
        } else {
            status = MM(controller_step)(&controller, &timing, &given, &command, &signals);
        }
        bad |= said(name, status);
        uint64_t hash = hashed(START, &command.torque, sizeof command.torque);
        hash = hashed(hash, &command.mode, sizeof command.mode);
        hash = hashed(hash, &command.findings, sizeof command.findings);
        hash = hashed(hash, &command.brake, sizeof command.brake);
        hash = hashed(hash, &command.ran, sizeof command.ran);
        hash = hashed(hash, &command.flags, sizeof command.flags);
        say_tick(name, tick, hashed(hash, &signals, sizeof signals));
    }
    return bad;
}

int ticks(void)
{
    static const struct {
        const char *name;
        int32_t law, engine;
    } laws[] = {
        {"bfsmc", MM_LAW_BFSMC, MM_FUZZY_ENGINE_DEFAULT},
        {"bfsmc-q15", MM_LAW_BFSMC, MM_FUZZY_ENGINE_Q15},
        {"bfsmc-surface", MM_LAW_BFSMC, MM_FUZZY_ENGINE_SURFACE},
        {"bfsmc-thesis", MM_LAW_BFSMC_THESIS, MM_FUZZY_ENGINE_DEFAULT},
        {"bsmc", MM_LAW_BSMC, MM_FUZZY_ENGINE_DEFAULT},
        {"bsmc-sat", MM_LAW_BSMC_SAT, MM_FUZZY_ENGINE_DEFAULT},
        {"ctc", MM_LAW_CTC, MM_FUZZY_ENGINE_DEFAULT},
        {"pid", MM_LAW_PID, MM_FUZZY_ENGINE_DEFAULT},
        {"lqr", MM_LAW_LQR, MM_FUZZY_ENGINE_DEFAULT},
        {"smc-decentralized", MM_LAW_SMC_DECENTRALIZED, MM_FUZZY_ENGINE_DEFAULT},
        {"backstepping-adaptive", MM_LAW_BACKSTEPPING_ADAPTIVE, MM_FUZZY_ENGINE_DEFAULT},
        {"super-twisting", MM_LAW_SUPER_TWISTING, MM_FUZZY_ENGINE_DEFAULT},
    };
    int bad = 0;
    stack_used();
    bad |= begin(MM_LAW_BFSMC, MM_FUZZY_ENGINE_DEFAULT, MM_ESTIMATOR_KIND_NONE, 0);
    say_stack("init");
    MM(input) input;
    MM(output) output;
    uint32_t seed = 7;
    fill(&input, &seed);
    stack_used();
    bad |= said("update", MM(controller_update)(&controller, &input, &output, NULL));
    say_stack("update");
    for (size_t i = 0; i < sizeof laws / sizeof laws[0]; i++) {
        bad |= updates(laws[i].name, laws[i].law, laws[i].engine);
    }
    say_stack("all-laws");
    bad |= measured("filtered-difference", MM_ESTIMATOR_KIND_FILTERED_DIFFERENCE);
    bad |= measured("observer", MM_ESTIMATOR_KIND_OBSERVER);
    say_stack("measured");
    bad |= supervised("supervised");
    say_stack("supervised");
    return bad;
}
