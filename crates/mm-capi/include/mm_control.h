/**
 * @file mm_control.h
 * @brief Torque control of a mobile manipulator: backstepping fuzzy sliding mode control and its kin.
 *
 * Generated from the Rust sources by `cargo xtask capi --bless`; not to be edited.
 *
 * Units are SI and radians; names of fields end in theirs. The world's z axis points upwards, counter-clockwise is positive, heading 0
 * looks along x; positive shoulder and elbow angles raise the arm. Errors are actual minus desired. Torques are right wheel
 * before left, channels forward, yaw, joints 1 to 3.
 *
 * Precision: names that begin with mm_ work in double precision and give the same bits as simulator and Python; names that begin with
 * mmf_ are the same in single precision, without a single operation in double precision in their updates. What knows no precision
 * (mm_status, mm_problem, kinds, flags) exists once.
 *
 * Errors: every call returns an mm_status. After anything but MM_STATUS_OK outputs and controller are as they were, but for the
 * mm_problem. Outputs may overlap inputs. No call allocates, blocks, logs, aborts or keeps state outside the caller's memory.
 *
 * Pointers: null and misaligned ones are refused, and memory that is no controller. Any other pointer has to point at what its type
 * says, readable and, unless it is const, writable during the call; an mm_controller has to be one that was filled by an init call,
 * cleared, or written by nobody but these functions.
 *
 * Threads and interrupts: different controllers are independent; calls on the same one must not overlap in time.
 *
 * @code
 * static mm_controller controller;
 * mm_params params;
 * mm_params_thesis(&params);
 * params.robot.links[2].mass_kg = 4.5;
 * if (mm_controller_init(&controller, sizeof controller, MM_ABI_VERSION, &params, NULL) != MM_STATUS_OK) { stop(); }
 * // every params.period_s:
 * if (mm_controller_update(&controller, &input, &output, NULL) != MM_STATUS_OK) { stop(); }
 * @endcode
 */

#ifndef MM_CONTROL_H
#define MM_CONTROL_H

#include <stddef.h>
#include <stdint.h>

/**
 * Version of this interface: of the functions, of the structs and of the size of a controller.
 */
#define MM_ABI_VERSION 1

/**
 * Joints of the arm.
 */
#define MM_JOINTS 3

/**
 * Channels of the robot: forward, yaw, joint 1, joint 2, joint 3, in this order.
 */
#define MM_CHANNELS 5

/**
 * Flag: a torque was cut to its limit.
 */
#define MM_FLAG_SATURATED 1

/**
 * Flag: the arm is near a singularity, where the pseudo-inverse is damped if damping is on.
 */
#define MM_FLAG_NEAR_SINGULAR 2

/**
 * Flag: the correction of the tip's error was cut to its largest speed, or the base held to its own.
 */
#define MM_FLAG_SPEED_LIMITED 4

/**
 * Flag: a joint's rate was held to the bound that keeps it within its limits.
 */
#define MM_FLAG_JOINT_LIMITED 8

/**
 * Flag: a joint is outside its limits.
 */
#define MM_FLAG_BEYOND_JOINT_LIMIT 16

/**
 * Finding: a number of the measured state is infinite or NaN.
 */
#define MM_FINDING_STATE_NOT_FINITE 1

/**
 * Finding: a measured number is outside its range.
 */
#define MM_FINDING_STATE_RANGE 2

/**
 * Finding: a measured number changed faster than the robot can move.
 */
#define MM_FINDING_STATE_RATE 4

/**
 * Finding: the measured state stands still although the robot moves.
 */
#define MM_FINDING_STATE_FROZEN 8

/**
 * Finding: the input is too old.
 */
#define MM_FINDING_STALE 16

/**
 * Finding: a number of the reference is infinite, NaN or outside its range.
 */
#define MM_FINDING_REFERENCE 32

/**
 * Finding: the update came too early, or the clock ran backwards.
 */
#define MM_FINDING_EARLY 64

/**
 * Finding: the update came too late.
 */
#define MM_FINDING_LATE 128

/**
 * Finding: no input came.
 */
#define MM_FINDING_MISSED 256

/**
 * Finding: the stack refused the input.
 */
#define MM_FINDING_REFUSED 512

/**
 * Bytes of a parameter's name, with the zero at its end.
 */
#define MM_NAME_SIZE 48

/**
 * Bytes of an mm_controller; the caller owns them, on the stack, as a static or in a struct of its own.
 */
#define MM_CONTROLLER_SIZE 4096

/**
 * Bytes of an mmf_controller.
 */
#define MMF_CONTROLLER_SIZE 2048

/**
 * How a call ended. After anything but MM_STATUS_OK outputs and controller are as they were before the call.
 */
enum mm_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Done.
     */
    MM_STATUS_OK = 0,
    /**
     * A pointer that must not be null is null.
     */
    MM_STATUS_NULL_POINTER = 1,
    /**
     * A pointer is not aligned for what it points at.
     */
    MM_STATUS_MISALIGNED = 2,
    /**
     * The caller was compiled with a header of another ABI version.
     */
    MM_STATUS_ABI_VERSION = 3,
    /**
     * The caller's controller has another size than the library's.
     */
    MM_STATUS_STORAGE_SIZE = 4,
    /**
     * The storage holds no controller of this precision: never initialized, cleared, or something else.
     */
    MM_STATUS_NOT_INITIALIZED = 5,
    /**
     * A supervised controller was given to an unsupervised call; see mm_controller_step.
     */
    MM_STATUS_SUPERVISED = 6,
    /**
     * An unsupervised controller was given to a supervised call; see mm_params.supervised.
     */
    MM_STATUS_NOT_SUPERVISED = 7,
    /**
     * A measurement was given to a controller without estimator; see mm_estimator.kind.
     */
    MM_STATUS_NO_ESTIMATOR = 8,
    /**
     * A number of the configuration is infinite or NaN.
     */
    MM_STATUS_CONFIGURATION_NOT_FINITE = 16,
    /**
     * A number of the velocity is infinite or NaN.
     */
    MM_STATUS_VELOCITY_NOT_FINITE = 17,
    /**
     * A number of the reference is infinite or NaN.
     */
    MM_STATUS_REFERENCE_NOT_FINITE = 18,
    /**
     * A wheel angle is infinite or NaN.
     */
    MM_STATUS_WHEELS_NOT_FINITE = 19,
    /**
     * The torque or the controller's memory would be infinite or NaN: an input is far beyond any robot.
     */
    MM_STATUS_OVERFLOW = 20,
    /**
     * A parameter is infinite or NaN.
     */
    MM_STATUS_PARAMETER_NOT_FINITE = 32,
    /**
     * A parameter has to be above zero.
     */
    MM_STATUS_PARAMETER_NOT_POSITIVE = 33,
    /**
     * A parameter has to be zero or above.
     */
    MM_STATUS_PARAMETER_NEGATIVE = 34,
    /**
     * A parameter lies outside its range, or is no kind that there is.
     */
    MM_STATUS_PARAMETER_OUT_OF_RANGE = 35,
    /**
     * The lower bound of a parameter is not below the upper one.
     */
    MM_STATUS_PARAMETER_INVERTED = 36,
    /**
     * For want of an inertia the mass matrix would not be positive definite.
     */
    MM_STATUS_PARAMETER_NOT_POSITIVE_DEFINITE = 37,
    /**
     * The Riccati equation of MM_LAW_LQR was not solved: acceptable values too far apart.
     */
    MM_STATUS_RICCATI = 38,
    /**
     * The parameters were refused for another reason.
     */
    MM_STATUS_REFUSED = 39,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum mm_status mm_status;
#else
typedef int32_t mm_status; /**< A number of enum mm_status. */
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Inner laws. None has the number 0, so that forgotten parameters are refused.
 */
enum mm_law
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Backstepping and sliding mode with sign.
     */
    MM_LAW_BSMC = 1,
    /**
     * The same with a boundary layer.
     */
    MM_LAW_BSMC_SAT = 2,
    /**
     * Sign and the fuzzy term of the thesis, as printed.
     */
    MM_LAW_BFSMC_THESIS = 3,
    /**
     * Continuous fuzzy surface and a learned disturbance: the one to begin with.
     */
    MM_LAW_BFSMC = 4,
    /**
     * Computed torque.
     */
    MM_LAW_CTC = 5,
    /**
     * PID, the base by partial feedback linearization.
     */
    MM_LAW_PID = 6,
    /**
     * Linear quadratic regulator about the rest posture.
     */
    MM_LAW_LQR = 7,
    /**
     * Sliding modes of base and arm apart.
     */
    MM_LAW_SMC_DECENTRALIZED = 8,
    /**
     * Adaptive backstepping.
     */
    MM_LAW_BACKSTEPPING_ADAPTIVE = 9,
    /**
     * Super-twisting, a sliding mode of second order.
     */
    MM_LAW_SUPER_TWISTING = 10,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum mm_law mm_law;
#else
typedef int32_t mm_law; /**< A number of enum mm_law. */
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How MM_LAW_BFSMC and MM_LAW_BFSMC_THESIS evaluate their fuzzy system; other laws take the default alone.
 */
enum mm_fuzzy_engine
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * What the law chooses: a table for MM_LAW_BFSMC, the rules for MM_LAW_BFSMC_THESIS.
     */
    MM_FUZZY_ENGINE_DEFAULT = 0,
    /**
     * 65 equally spaced knots in floating point: the fastest with a floating-point unit.
     */
    MM_FUZZY_ENGINE_TABLE = 1,
    /**
     * The rules, centroid in closed form.
     */
    MM_FUZZY_ENGINE_EXACT = 2,
    /**
     * The rules in whole numbers of 16 bits.
     */
    MM_FUZZY_ENGINE_Q15 = 3,
    /**
     * A compiled table of whole numbers: the fastest without a floating-point unit.
     */
    MM_FUZZY_ENGINE_SURFACE = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum mm_fuzzy_engine mm_fuzzy_engine;
#else
typedef int32_t mm_fuzzy_engine; /**< A number of enum mm_fuzzy_engine. */
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How the velocity is found where only positions are measured.
 */
enum mm_estimator_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Not at all: the caller knows the velocity.
     */
    MM_ESTIMATOR_KIND_NONE = 0,
    /**
     * Differences through a low-pass of second order; it lags by sqrt(2)/(2 pi cutoff).
     */
    MM_ESTIMATOR_KIND_FILTERED_DIFFERENCE = 1,
    /**
     * A tracking observer with the dynamics of the robot.
     */
    MM_ESTIMATOR_KIND_OBSERVER = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum mm_estimator_kind mm_estimator_kind;
#else
typedef int32_t mm_estimator_kind; /**< A number of enum mm_estimator_kind. */
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What the supervisor does.
 */
enum mm_mode
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * The law decides.
     */
    MM_MODE_RUN = 0,
    /**
     * The last torque of the law is held.
     */
    MM_MODE_HOLD = 1,
    /**
     * The robot is brought to rest and its weight held.
     */
    MM_MODE_STOP = 2,
    /**
     * No torque, brakes on; left by mm_controller_reset only.
     */
    MM_MODE_FAULT = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum mm_mode mm_mode;
#else
typedef int32_t mm_mode; /**< A number of enum mm_mode. */
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * One link of the arm, base to tip; link 1 stands upright, so that its axis is the vertical.
 */
typedef struct {
    /**
     * Distance from this joint to the next, or to the tip, m.
     */
    double length_m;
    /**
     * Mass, kg.
     */
    double mass_kg;
    /**
     * Centre of mass, from the joint along the link, m.
     */
    double com_m;
    /**
     * Moments of inertia through the centre of mass: about the link's own axis, about the pitch axis, about the third, kg m^2.
     */
    double inertia_kg_m2[3];
    /**
     * Least and largest angle of its joint, rad.
     */
    double joint_limit_rad[2];
    /**
     * Largest torque of its joint, N m.
     */
    double torque_limit_n_m;
} mm_link;

/**
 * Friction in wheel bearings and joints: viscous, and Coulomb smoothed through zero speed.
 */
typedef struct {
    /**
     * Viscous coefficient of each wheel, N m s/rad.
     */
    double wheel_viscous_n_m_s;
    /**
     * Coulomb torque of each wheel, N m.
     */
    double wheel_coulomb_n_m;
    /**
     * Viscous coefficient of each joint, N m s/rad.
     */
    double joint_viscous_n_m_s[MM_JOINTS];
    /**
     * Coulomb torque of each joint, N m.
     */
    double joint_coulomb_n_m[MM_JOINTS];
    /**
     * Speed at which the Coulomb torque has reached 71 % of its size, rad/s.
     */
    double smoothing_rad_s;
} mm_friction;

/**
 * A robot: a base on two driven wheels that carries an arm of yaw, pitch and pitch.
 */
typedef struct {
    /**
     * Mass of the base with its wheels, kg.
     */
    double base_mass_kg;
    /**
     * Moment of inertia of the base about the vertical through its centre of mass, kg m^2.
     */
    double base_yaw_inertia_kg_m2;
    /**
     * Centre of mass of the base, ahead of the axle, m.
     */
    double base_com_offset_m;
    /**
     * Yaw axis of the arm, ahead of the axle, m.
     */
    double arm_offset_m;
    /**
     * Height of the arm's foot above the ground, m.
     */
    double mount_height_m;
    /**
     * Radius of the wheels, m.
     */
    double wheel_radius_m;
    /**
     * Distance between the wheels, m.
     */
    double track_width_m;
    /**
     * Acceleration of gravity, m/s^2.
     */
    double gravity_m_s2;
    /**
     * Largest torque of each wheel, N m.
     */
    double wheel_torque_limit_n_m;
    /**
     * Forward speed up to which the model's assumptions hold, m/s.
     */
    double speed_limit_m_s;
    /**
     * Joint angles that the arm returns to where the task leaves it free, rad.
     */
    double rest_posture_rad[MM_JOINTS];
    /**
     * Links, base to tip.
     */
    mm_link links[MM_JOINTS];
    /**
     * Friction; all zero but smoothing_rad_s for none.
     */
    mm_friction friction;
} mm_robot;

/**
 * Gains of the outer loop and of the sliding surface. Arrays of five hold forward, yaw, joint 1, joint 2, joint 3.
 */
typedef struct {
    /**
     * Decay rate of the tip's error along x, y, z, 1/s.
     */
    double position_gain_1_s[3];
    /**
     * Gain on the integral of velocity minus virtual control in the sliding variable, 1/s.
     */
    double sliding_gain_1_s[MM_CHANNELS];
    /**
     * Weight of each quasi-velocity in the pseudo-inverse.
     */
    double weights[MM_CHANNELS];
    /**
     * Pull towards the rest posture, 1/s.
     */
    double posture_gain_1_s;
    /**
     * Push off a joint limit, rad/s.
     */
    double joint_limit_gain_rad_s;
    /**
     * Distance from a joint limit at which the push begins, rad.
     */
    double joint_limit_margin_rad;
    /**
     * Climb of the manipulability below its threshold, rad^2/s.
     */
    double manipulability_gain_rad_s;
    /**
     * Manipulability below which damping and climb set in.
     */
    double manipulability_threshold;
    /**
     * Largest damping.
     */
    double damping_max;
    /**
     * Largest speed that the correction of the tip's error asks for, m/s.
     */
    double correction_speed_limit_m_s;
    /**
     * Rate at which the joint rates asked for may approach a joint limit, 1/s; 0 sets no bound, on the forward speed neither.
     */
    double joint_limit_rate_1_s;
    /**
     * Time from the first update over which the base is held and the arm alone follows, s.
     */
    double base_hold_s;
    /**
     * Time over which the base's share then rises from 0 to 1, s.
     */
    double base_release_s;
    /**
     * Not 0: plain minimum norm, without posture task, damping, bounds on rates and weights.
     */
    uint32_t minimum_norm;
} mm_outer;

/**
 * Gains of the inner laws; a law takes the ones that it knows. Arrays hold forward, yaw, joint 1, joint 2, joint 3.
 */
typedef struct {
    /**
     * Switching gain k, N and N m.
     */
    double switching_gain[MM_CHANNELS];
    /**
     * Half-width of the boundary layer of MM_LAW_BSMC_SAT, m/s and rad/s.
     */
    double boundary_layer[MM_CHANNELS];
    /**
     * Force at an output of 1 of the fuzzy system, N and N m.
     */
    double fuzzy_gain[MM_CHANNELS];
    /**
     * Sliding variable that enters the fuzzy system as 1, m/s and rad/s.
     */
    double fuzzy_scale[MM_CHANNELS];
    /**
     * Bandwidth of the learned disturbance, 1/s; 0 switches learning off.
     */
    double observer_bandwidth_1_s;
    /**
     * Largest learned disturbance, N and N m.
     */
    double learning_limit[MM_CHANNELS];
    /**
     * Margin asked of the reaching condition, N and N m.
     */
    double reaching_margin[MM_CHANNELS];
    /**
     * Gain on velocity minus virtual control (MM_LAW_CTC, MM_LAW_PID) or on s (MM_LAW_BACKSTEPPING_ADAPTIVE), 1/s.
     */
    double damping_gain_1_s[MM_CHANNELS];
    /**
     * Gain on the integral of that, 1/s^2.
     */
    double stiffness_gain_1_s2[MM_CHANNELS];
    /**
     * Gain on the integral of the integral, of MM_LAW_PID, 1/s^3.
     */
    double integral_gain_1_s3[MM_CHANNELS];
    /**
     * Acceptable integral of velocity minus virtual control, of MM_LAW_LQR, m and rad.
     */
    double acceptable_position[MM_CHANNELS];
    /**
     * Acceptable velocity minus virtual control, of MM_LAW_LQR, m/s and rad/s.
     */
    double acceptable_velocity[MM_CHANNELS];
    /**
     * Acceptable force, of MM_LAW_LQR, N and N m.
     */
    double acceptable_force[MM_CHANNELS];
    /**
     * Adaptation of the bodies' factors, 1/J.
     */
    double body_adaptation_gain_1_j;
    /**
     * Least and largest factor on a body's inertia.
     */
    double body_factor[2];
    /**
     * Adaptation of the learned force, 1/s^2.
     */
    double force_adaptation_gain_1_s2;
    /**
     * k1 of MM_LAW_SUPER_TWISTING, N (m/s)^-1/2 and N m (rad/s)^-1/2.
     */
    double twisting_gain[MM_CHANNELS];
    /**
     * k2 of MM_LAW_SUPER_TWISTING, N/s and N m/s.
     */
    double twisting_rate_gain[MM_CHANNELS];
    /**
     * Not 0: MM_LAW_BFSMC_THESIS keeps the misprinted sign of the thesis.
     */
    uint32_t misprint_sign;
    /**
     * Not 0: MM_LAW_BFSMC_THESIS keeps the misprinted channels of the thesis.
     */
    uint32_t misprint_channels;
} mm_gains;

/**
 * How the velocity is found where only positions are measured.
 */
typedef struct {
    /**
     * Cutoff, Hz; below half the update rate. Not looked at for MM_ESTIMATOR_KIND_NONE.
     */
    double cutoff_hz;
    /**
     * Age of a measurement when it is used, s: the estimate is carried forward by it.
     */
    double delay_s;
    /**
     * An mm_estimator_kind.
     */
    int32_t kind;
} mm_estimator;

/**
 * Limits of plausibility, and how long each mode may last. Arrays hold forward, yaw, joint 1, joint 2, joint 3.
 */
typedef struct {
    /**
     * Largest distance of the base, and of the reference, from the origin along each axis, m.
     */
    double position_m;
    /**
     * How far beyond its limits a joint may read, rad.
     */
    double joint_margin_rad;
    /**
     * Largest speeds, m/s and rad/s; the first is the largest of the reference too.
     */
    double speed[MM_CHANNELS];
    /**
     * Largest accelerations, m/s^2 and rad/s^2: how much a measured velocity may change in a period.
     */
    double acceleration[MM_CHANNELS];
    /**
     * Noise and resolution of a measured position, m and rad.
     */
    double position_noise;
    /**
     * The same of a measured velocity, m/s and rad/s; below it the robot counts as at rest.
     */
    double velocity_noise;
    /**
     * Largest step of the reference in a period besides its velocity, m.
     */
    double reference_step_m;
    /**
     * Largest acceleration of the reference along each axis, m/s^2.
     */
    double reference_acceleration_m_s2;
    /**
     * Largest age of an input, s.
     */
    double age_s;
    /**
     * Rate at which a stop takes the speed away, 1/s; at most 0.1 per period of it is used.
     */
    double braking_rate_1_s;
    /**
     * Updates that the last torque is held for.
     */
    uint32_t hold_periods;
    /**
     * Plausible inputs in a row after which a stopped robot runs again; UINT32_MAX: never by itself.
     */
    uint32_t recovery_periods;
    /**
     * Updates without a plausible state after which a stop becomes a fault.
     */
    uint32_t blind_periods;
    /**
     * Updates in which a stop has to bring the robot to rest.
     */
    uint32_t stop_periods;
} mm_supervisor;

/**
 * Everything that makes a controller: begin with mm_params_thesis or mm_params_defaults, then change what differs.
 */
typedef struct {
    /**
     * Time between two updates, s.
     */
    double period_s;
    /**
     * The robot.
     */
    mm_robot robot;
    /**
     * Outer loop and sliding surface.
     */
    mm_outer outer;
    /**
     * Gains of the inner law.
     */
    mm_gains gains;
    /**
     * Estimator.
     */
    mm_estimator estimator;
    /**
     * Supervisor; looked at where supervised is not 0.
     */
    mm_supervisor supervisor;
    /**
     * Inner law: an mm_law.
     */
    int32_t law;
    /**
     * Form of its fuzzy system: an mm_fuzzy_engine.
     */
    int32_t fuzzy_engine;
    /**
     * Not 0: mm_controller_step and its kin work, which always give a safe torque. 0: mm_controller_update and its kin.
     */
    uint32_t supervised;
} mm_params;

/**
 * Which parameter was refused. Empty where none is to blame.
 */
typedef struct {
    /**
     * Name of the field, as in the structs below and in scenario files; it ends with a zero. Fields of links carry no link number.
     */
    char parameter[MM_NAME_SIZE];
} mm_problem;

/**
 * A controller in double precision: memory that mm_controller_init fills and the other calls use.
 *
 * It holds no address: it may be copied and moved while no call is running. What is in it is the library's business.
 */
typedef struct {
    /**
     * Not for the caller.
     */
    uint64_t opaque[512];
} mm_controller;

/**
 * Where the robot is.
 */
typedef struct {
    /**
     * Midpoint of the wheel axle along the world's x axis, m.
     */
    double x_m;
    /**
     * The same along the world's y axis, m.
     */
    double y_m;
    /**
     * Direction in which the base looks, counter-clockwise from the world's x axis, rad.
     */
    double heading_rad;
    /**
     * Joint angles: yaw of the arm counter-clockwise, shoulder from level, elbow from link 2, both positive upwards, rad.
     */
    double joints_rad[MM_JOINTS];
} mm_configuration;

/**
 * How the robot moves: quasi-velocities.
 */
typedef struct {
    /**
     * Forward speed of the axle's midpoint, m/s.
     */
    double forward_m_s;
    /**
     * Yaw rate of the base, counter-clockwise, rad/s.
     */
    double yaw_rate_rad_s;
    /**
     * Joint rates, rad/s.
     */
    double joints_rad_s[MM_JOINTS];
} mm_velocity;

/**
 * Where the tip shall be, and how that moves, in the world frame: x, y, z upwards.
 */
typedef struct {
    /**
     * Position, m.
     */
    double position_m[3];
    /**
     * Velocity, m/s.
     */
    double velocity_m_s[3];
    /**
     * Acceleration, m/s^2.
     */
    double acceleration_m_s2[3];
} mm_reference;

/**
 * What enters an update from configuration and velocity.
 */
typedef struct {
    /**
     * Configuration of the robot.
     */
    mm_configuration configuration;
    /**
     * Its velocity.
     */
    mm_velocity velocity;
    /**
     * The reference at this instant.
     */
    mm_reference reference;
} mm_input;

/**
 * Torques of the actuators.
 */
typedef struct {
    /**
     * Right wheel, positive forwards, N m.
     */
    double right_n_m;
    /**
     * Left wheel, positive forwards, N m.
     */
    double left_n_m;
    /**
     * Joints, N m.
     */
    double joints_n_m[MM_JOINTS];
} mm_torque;

/**
 * What an update gives.
 */
typedef struct {
    /**
     * Torque to apply until the next update, within the limits.
     */
    mm_torque torque;
    /**
     * Numerical outcomes, none of them an error: MM_FLAG_ bits.
     */
    uint32_t flags;
} mm_output;

/**
 * Generalized forces along the quasi-velocities.
 */
typedef struct {
    /**
     * Along the forward speed, N.
     */
    double forward_n;
    /**
     * About the vertical, N m.
     */
    double yaw_n_m;
    /**
     * About the joints, N m.
     */
    double joints_n_m[MM_JOINTS];
} mm_force;

/**
 * The signals of the law, for logs and monitors. Errors are actual minus desired.
 */
typedef struct {
    /**
     * Velocity that the law worked with: the caller's, or the estimated one.
     */
    mm_velocity velocity;
    /**
     * Tip by the controller's kinematics, in the world frame, m.
     */
    double tip_m[3];
    /**
     * Tip error, m.
     */
    double error_m[3];
    /**
     * Virtual control: the velocity that the outer loop asks for.
     */
    mm_velocity virtual_velocity;
    /**
     * Reference velocity of the sliding mode.
     */
    mm_velocity reference_velocity;
    /**
     * Its rate, m/s^2 and rad/s^2.
     */
    mm_velocity reference_acceleration;
    /**
     * Sliding variable: velocity minus reference velocity.
     */
    mm_velocity sliding;
    /**
     * The law's force as far as it takes the model as true.
     */
    mm_force equivalent;
    /**
     * Force of the fuzzy system.
     */
    mm_force fuzzy;
    /**
     * Learned disturbance.
     */
    mm_force learned;
    /**
     * Torque asked for, before the limits.
     */
    mm_torque commanded;
    /**
     * det(J J').
     */
    double manipulability_squared;
    /**
     * Square of the damping.
     */
    double damping_squared;
} mm_signals;

/**
 * What enters an update from measured positions.
 */
typedef struct {
    /**
     * Configuration: the pose by whatever locates the base, the joints by their encoders.
     */
    mm_configuration configuration;
    /**
     * Angle of the right wheel, positive forwards, rad; counting turns or not.
     */
    double right_wheel_rad;
    /**
     * Angle of the left wheel, rad.
     */
    double left_wheel_rad;
    /**
     * The reference at this instant.
     */
    mm_reference reference;
    /**
     * Not 0 where the wheels have encoders; else the two angles are not looked at.
     */
    uint32_t has_wheels;
} mm_measurement;

/**
 * What the clock says of a supervised update.
 */
typedef struct {
    /**
     * Time since the update before, s; the period for the first.
     */
    double elapsed_s;
    /**
     * Age of the input beyond mm_estimator.delay_s, s.
     */
    double age_s;
} mm_timing;

/**
 * What a supervised update gives.
 */
typedef struct {
    /**
     * Torque to apply until the next update: finite and within the limits, whatever came in.
     */
    mm_torque torque;
    /**
     * What the supervisor does: an mm_mode.
     */
    int32_t mode;
    /**
     * What was wrong with the input: MM_FINDING_ bits.
     */
    uint32_t findings;
    /**
     * 1 where mechanical brakes, if the robot has them, shall hold it; else 0.
     */
    uint32_t brake;
    /**
     * 1 where the law ran, so that flags and signals are of this update; else 0.
     */
    uint32_t ran;
    /**
     * Numerical outcomes of the law: MM_FLAG_ bits; 0 where it did not run.
     */
    uint32_t flags;
} mm_command;

/**
 * One link of the arm, base to tip; link 1 stands upright, so that its axis is the vertical.
 */
typedef struct {
    /**
     * Distance from this joint to the next, or to the tip, m.
     */
    float length_m;
    /**
     * Mass, kg.
     */
    float mass_kg;
    /**
     * Centre of mass, from the joint along the link, m.
     */
    float com_m;
    /**
     * Moments of inertia through the centre of mass: about the link's own axis, about the pitch axis, about the third, kg m^2.
     */
    float inertia_kg_m2[3];
    /**
     * Least and largest angle of its joint, rad.
     */
    float joint_limit_rad[2];
    /**
     * Largest torque of its joint, N m.
     */
    float torque_limit_n_m;
} mmf_link;

/**
 * Friction in wheel bearings and joints: viscous, and Coulomb smoothed through zero speed.
 */
typedef struct {
    /**
     * Viscous coefficient of each wheel, N m s/rad.
     */
    float wheel_viscous_n_m_s;
    /**
     * Coulomb torque of each wheel, N m.
     */
    float wheel_coulomb_n_m;
    /**
     * Viscous coefficient of each joint, N m s/rad.
     */
    float joint_viscous_n_m_s[MM_JOINTS];
    /**
     * Coulomb torque of each joint, N m.
     */
    float joint_coulomb_n_m[MM_JOINTS];
    /**
     * Speed at which the Coulomb torque has reached 71 % of its size, rad/s.
     */
    float smoothing_rad_s;
} mmf_friction;

/**
 * A robot: a base on two driven wheels that carries an arm of yaw, pitch and pitch.
 */
typedef struct {
    /**
     * Mass of the base with its wheels, kg.
     */
    float base_mass_kg;
    /**
     * Moment of inertia of the base about the vertical through its centre of mass, kg m^2.
     */
    float base_yaw_inertia_kg_m2;
    /**
     * Centre of mass of the base, ahead of the axle, m.
     */
    float base_com_offset_m;
    /**
     * Yaw axis of the arm, ahead of the axle, m.
     */
    float arm_offset_m;
    /**
     * Height of the arm's foot above the ground, m.
     */
    float mount_height_m;
    /**
     * Radius of the wheels, m.
     */
    float wheel_radius_m;
    /**
     * Distance between the wheels, m.
     */
    float track_width_m;
    /**
     * Acceleration of gravity, m/s^2.
     */
    float gravity_m_s2;
    /**
     * Largest torque of each wheel, N m.
     */
    float wheel_torque_limit_n_m;
    /**
     * Forward speed up to which the model's assumptions hold, m/s.
     */
    float speed_limit_m_s;
    /**
     * Joint angles that the arm returns to where the task leaves it free, rad.
     */
    float rest_posture_rad[MM_JOINTS];
    /**
     * Links, base to tip.
     */
    mmf_link links[MM_JOINTS];
    /**
     * Friction; all zero but smoothing_rad_s for none.
     */
    mmf_friction friction;
} mmf_robot;

/**
 * Gains of the outer loop and of the sliding surface. Arrays of five hold forward, yaw, joint 1, joint 2, joint 3.
 */
typedef struct {
    /**
     * Decay rate of the tip's error along x, y, z, 1/s.
     */
    float position_gain_1_s[3];
    /**
     * Gain on the integral of velocity minus virtual control in the sliding variable, 1/s.
     */
    float sliding_gain_1_s[MM_CHANNELS];
    /**
     * Weight of each quasi-velocity in the pseudo-inverse.
     */
    float weights[MM_CHANNELS];
    /**
     * Pull towards the rest posture, 1/s.
     */
    float posture_gain_1_s;
    /**
     * Push off a joint limit, rad/s.
     */
    float joint_limit_gain_rad_s;
    /**
     * Distance from a joint limit at which the push begins, rad.
     */
    float joint_limit_margin_rad;
    /**
     * Climb of the manipulability below its threshold, rad^2/s.
     */
    float manipulability_gain_rad_s;
    /**
     * Manipulability below which damping and climb set in.
     */
    float manipulability_threshold;
    /**
     * Largest damping.
     */
    float damping_max;
    /**
     * Largest speed that the correction of the tip's error asks for, m/s.
     */
    float correction_speed_limit_m_s;
    /**
     * Rate at which the joint rates asked for may approach a joint limit, 1/s; 0 sets no bound, on the forward speed neither.
     */
    float joint_limit_rate_1_s;
    /**
     * Time from the first update over which the base is held and the arm alone follows, s.
     */
    float base_hold_s;
    /**
     * Time over which the base's share then rises from 0 to 1, s.
     */
    float base_release_s;
    /**
     * Not 0: plain minimum norm, without posture task, damping, bounds on rates and weights.
     */
    uint32_t minimum_norm;
} mmf_outer;

/**
 * Gains of the inner laws; a law takes the ones that it knows. Arrays hold forward, yaw, joint 1, joint 2, joint 3.
 */
typedef struct {
    /**
     * Switching gain k, N and N m.
     */
    float switching_gain[MM_CHANNELS];
    /**
     * Half-width of the boundary layer of MM_LAW_BSMC_SAT, m/s and rad/s.
     */
    float boundary_layer[MM_CHANNELS];
    /**
     * Force at an output of 1 of the fuzzy system, N and N m.
     */
    float fuzzy_gain[MM_CHANNELS];
    /**
     * Sliding variable that enters the fuzzy system as 1, m/s and rad/s.
     */
    float fuzzy_scale[MM_CHANNELS];
    /**
     * Bandwidth of the learned disturbance, 1/s; 0 switches learning off.
     */
    float observer_bandwidth_1_s;
    /**
     * Largest learned disturbance, N and N m.
     */
    float learning_limit[MM_CHANNELS];
    /**
     * Margin asked of the reaching condition, N and N m.
     */
    float reaching_margin[MM_CHANNELS];
    /**
     * Gain on velocity minus virtual control (MM_LAW_CTC, MM_LAW_PID) or on s (MM_LAW_BACKSTEPPING_ADAPTIVE), 1/s.
     */
    float damping_gain_1_s[MM_CHANNELS];
    /**
     * Gain on the integral of that, 1/s^2.
     */
    float stiffness_gain_1_s2[MM_CHANNELS];
    /**
     * Gain on the integral of the integral, of MM_LAW_PID, 1/s^3.
     */
    float integral_gain_1_s3[MM_CHANNELS];
    /**
     * Acceptable integral of velocity minus virtual control, of MM_LAW_LQR, m and rad.
     */
    float acceptable_position[MM_CHANNELS];
    /**
     * Acceptable velocity minus virtual control, of MM_LAW_LQR, m/s and rad/s.
     */
    float acceptable_velocity[MM_CHANNELS];
    /**
     * Acceptable force, of MM_LAW_LQR, N and N m.
     */
    float acceptable_force[MM_CHANNELS];
    /**
     * Adaptation of the bodies' factors, 1/J.
     */
    float body_adaptation_gain_1_j;
    /**
     * Least and largest factor on a body's inertia.
     */
    float body_factor[2];
    /**
     * Adaptation of the learned force, 1/s^2.
     */
    float force_adaptation_gain_1_s2;
    /**
     * k1 of MM_LAW_SUPER_TWISTING, N (m/s)^-1/2 and N m (rad/s)^-1/2.
     */
    float twisting_gain[MM_CHANNELS];
    /**
     * k2 of MM_LAW_SUPER_TWISTING, N/s and N m/s.
     */
    float twisting_rate_gain[MM_CHANNELS];
    /**
     * Not 0: MM_LAW_BFSMC_THESIS keeps the misprinted sign of the thesis.
     */
    uint32_t misprint_sign;
    /**
     * Not 0: MM_LAW_BFSMC_THESIS keeps the misprinted channels of the thesis.
     */
    uint32_t misprint_channels;
} mmf_gains;

/**
 * How the velocity is found where only positions are measured.
 */
typedef struct {
    /**
     * Cutoff, Hz; below half the update rate. Not looked at for MM_ESTIMATOR_KIND_NONE.
     */
    float cutoff_hz;
    /**
     * Age of a measurement when it is used, s: the estimate is carried forward by it.
     */
    float delay_s;
    /**
     * An mm_estimator_kind.
     */
    int32_t kind;
} mmf_estimator;

/**
 * Limits of plausibility, and how long each mode may last. Arrays hold forward, yaw, joint 1, joint 2, joint 3.
 */
typedef struct {
    /**
     * Largest distance of the base, and of the reference, from the origin along each axis, m.
     */
    float position_m;
    /**
     * How far beyond its limits a joint may read, rad.
     */
    float joint_margin_rad;
    /**
     * Largest speeds, m/s and rad/s; the first is the largest of the reference too.
     */
    float speed[MM_CHANNELS];
    /**
     * Largest accelerations, m/s^2 and rad/s^2: how much a measured velocity may change in a period.
     */
    float acceleration[MM_CHANNELS];
    /**
     * Noise and resolution of a measured position, m and rad.
     */
    float position_noise;
    /**
     * The same of a measured velocity, m/s and rad/s; below it the robot counts as at rest.
     */
    float velocity_noise;
    /**
     * Largest step of the reference in a period besides its velocity, m.
     */
    float reference_step_m;
    /**
     * Largest acceleration of the reference along each axis, m/s^2.
     */
    float reference_acceleration_m_s2;
    /**
     * Largest age of an input, s.
     */
    float age_s;
    /**
     * Rate at which a stop takes the speed away, 1/s; at most 0.1 per period of it is used.
     */
    float braking_rate_1_s;
    /**
     * Updates that the last torque is held for.
     */
    uint32_t hold_periods;
    /**
     * Plausible inputs in a row after which a stopped robot runs again; UINT32_MAX: never by itself.
     */
    uint32_t recovery_periods;
    /**
     * Updates without a plausible state after which a stop becomes a fault.
     */
    uint32_t blind_periods;
    /**
     * Updates in which a stop has to bring the robot to rest.
     */
    uint32_t stop_periods;
} mmf_supervisor;

/**
 * Everything that makes a controller: begin with mm_params_thesis or mm_params_defaults, then change what differs.
 */
typedef struct {
    /**
     * Time between two updates, s.
     */
    float period_s;
    /**
     * The robot.
     */
    mmf_robot robot;
    /**
     * Outer loop and sliding surface.
     */
    mmf_outer outer;
    /**
     * Gains of the inner law.
     */
    mmf_gains gains;
    /**
     * Estimator.
     */
    mmf_estimator estimator;
    /**
     * Supervisor; looked at where supervised is not 0.
     */
    mmf_supervisor supervisor;
    /**
     * Inner law: an mm_law.
     */
    int32_t law;
    /**
     * Form of its fuzzy system: an mm_fuzzy_engine.
     */
    int32_t fuzzy_engine;
    /**
     * Not 0: mm_controller_step and its kin work, which always give a safe torque. 0: mm_controller_update and its kin.
     */
    uint32_t supervised;
} mmf_params;

/**
 * A controller in single precision, for mmf_controller_init and its kin; see mm_controller.
 */
typedef struct {
    /**
     * Not for the caller.
     */
    uint64_t opaque[256];
} mmf_controller;

/**
 * Where the robot is.
 */
typedef struct {
    /**
     * Midpoint of the wheel axle along the world's x axis, m.
     */
    float x_m;
    /**
     * The same along the world's y axis, m.
     */
    float y_m;
    /**
     * Direction in which the base looks, counter-clockwise from the world's x axis, rad.
     */
    float heading_rad;
    /**
     * Joint angles: yaw of the arm counter-clockwise, shoulder from level, elbow from link 2, both positive upwards, rad.
     */
    float joints_rad[MM_JOINTS];
} mmf_configuration;

/**
 * How the robot moves: quasi-velocities.
 */
typedef struct {
    /**
     * Forward speed of the axle's midpoint, m/s.
     */
    float forward_m_s;
    /**
     * Yaw rate of the base, counter-clockwise, rad/s.
     */
    float yaw_rate_rad_s;
    /**
     * Joint rates, rad/s.
     */
    float joints_rad_s[MM_JOINTS];
} mmf_velocity;

/**
 * Where the tip shall be, and how that moves, in the world frame: x, y, z upwards.
 */
typedef struct {
    /**
     * Position, m.
     */
    float position_m[3];
    /**
     * Velocity, m/s.
     */
    float velocity_m_s[3];
    /**
     * Acceleration, m/s^2.
     */
    float acceleration_m_s2[3];
} mmf_reference;

/**
 * What enters an update from configuration and velocity.
 */
typedef struct {
    /**
     * Configuration of the robot.
     */
    mmf_configuration configuration;
    /**
     * Its velocity.
     */
    mmf_velocity velocity;
    /**
     * The reference at this instant.
     */
    mmf_reference reference;
} mmf_input;

/**
 * Torques of the actuators.
 */
typedef struct {
    /**
     * Right wheel, positive forwards, N m.
     */
    float right_n_m;
    /**
     * Left wheel, positive forwards, N m.
     */
    float left_n_m;
    /**
     * Joints, N m.
     */
    float joints_n_m[MM_JOINTS];
} mmf_torque;

/**
 * What an update gives.
 */
typedef struct {
    /**
     * Torque to apply until the next update, within the limits.
     */
    mmf_torque torque;
    /**
     * Numerical outcomes, none of them an error: MM_FLAG_ bits.
     */
    uint32_t flags;
} mmf_output;

/**
 * Generalized forces along the quasi-velocities.
 */
typedef struct {
    /**
     * Along the forward speed, N.
     */
    float forward_n;
    /**
     * About the vertical, N m.
     */
    float yaw_n_m;
    /**
     * About the joints, N m.
     */
    float joints_n_m[MM_JOINTS];
} mmf_force;

/**
 * The signals of the law, for logs and monitors. Errors are actual minus desired.
 */
typedef struct {
    /**
     * Velocity that the law worked with: the caller's, or the estimated one.
     */
    mmf_velocity velocity;
    /**
     * Tip by the controller's kinematics, in the world frame, m.
     */
    float tip_m[3];
    /**
     * Tip error, m.
     */
    float error_m[3];
    /**
     * Virtual control: the velocity that the outer loop asks for.
     */
    mmf_velocity virtual_velocity;
    /**
     * Reference velocity of the sliding mode.
     */
    mmf_velocity reference_velocity;
    /**
     * Its rate, m/s^2 and rad/s^2.
     */
    mmf_velocity reference_acceleration;
    /**
     * Sliding variable: velocity minus reference velocity.
     */
    mmf_velocity sliding;
    /**
     * The law's force as far as it takes the model as true.
     */
    mmf_force equivalent;
    /**
     * Force of the fuzzy system.
     */
    mmf_force fuzzy;
    /**
     * Learned disturbance.
     */
    mmf_force learned;
    /**
     * Torque asked for, before the limits.
     */
    mmf_torque commanded;
    /**
     * det(J J').
     */
    float manipulability_squared;
    /**
     * Square of the damping.
     */
    float damping_squared;
} mmf_signals;

/**
 * What enters an update from measured positions.
 */
typedef struct {
    /**
     * Configuration: the pose by whatever locates the base, the joints by their encoders.
     */
    mmf_configuration configuration;
    /**
     * Angle of the right wheel, positive forwards, rad; counting turns or not.
     */
    float right_wheel_rad;
    /**
     * Angle of the left wheel, rad.
     */
    float left_wheel_rad;
    /**
     * The reference at this instant.
     */
    mmf_reference reference;
    /**
     * Not 0 where the wheels have encoders; else the two angles are not looked at.
     */
    uint32_t has_wheels;
} mmf_measurement;

/**
 * What the clock says of a supervised update.
 */
typedef struct {
    /**
     * Time since the update before, s; the period for the first.
     */
    float elapsed_s;
    /**
     * Age of the input beyond mm_estimator.delay_s, s.
     */
    float age_s;
} mmf_timing;

/**
 * What a supervised update gives.
 */
typedef struct {
    /**
     * Torque to apply until the next update: finite and within the limits, whatever came in.
     */
    mmf_torque torque;
    /**
     * What the supervisor does: an mm_mode.
     */
    int32_t mode;
    /**
     * What was wrong with the input: MM_FINDING_ bits.
     */
    uint32_t findings;
    /**
     * 1 where mechanical brakes, if the robot has them, shall hold it; else 0.
     */
    uint32_t brake;
    /**
     * 1 where the law ran, so that flags and signals are of this update; else 0.
     */
    uint32_t ran;
    /**
     * Numerical outcomes of the law: MM_FLAG_ bits; 0 where it did not run.
     */
    uint32_t flags;
} mmf_command;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Version of the library, such as "0.1.0".
 *
 * @return text that lives as long as the program
 */
const char *mm_version(void);

/**
 * ABI version that the library was built with, to compare with MM_ABI_VERSION.
 *
 * @return the version
 */
uint32_t mm_abi_version(void);

/**
 * What a status means, in English.
 *
 * @param[in] status  any number
 * @return text that lives as long as the program; "no such status" for a number that is none
 */
const char *mm_status_text(int32_t status);

/**
 * Fills parameters with the robot of the thesis, MM_LAW_BFSMC at 1 kHz and the defaults for these.
 *
 * @param[out] params  parameters, all fields
 * @return MM_STATUS_OK, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
 */
mm_status mm_params_thesis(mm_params *params);

/**
 * Fills parameters with what suits a robot, a law and a period: all fields but params.robot, params.law and params.period_s, which are
 * read and have to be set before.
 *
 * Gains follow the torque limits and the inertia of the robot; there is no estimator and no supervisor.
 *
 * @param[in,out] params   parameters
 * @param[out]    problem  which parameter was refused, or an empty name; may be NULL
 * @return MM_STATUS_OK, a MM_STATUS_PARAMETER_ status, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
 */
mm_status mm_params_defaults(mm_params *params,
                             mm_problem *problem);

/**
 * Makes a controller of parameters in the caller's memory, whatever was in it.
 *
 * Not for the control loop: it takes some hundred updates' time, for the fuzzy system is tabulated and, for MM_LAW_LQR, the Riccati
 * equation solved. On any status but MM_STATUS_OK the memory is as it was.
 *
 * @param[out] controller   the caller's memory; need not be cleared
 * @param[in]  size         sizeof(mm_controller)
 * @param[in]  abi_version  MM_ABI_VERSION
 * @param[in]  params       parameters; copied
 * @param[out] problem      which parameter was refused, or an empty name; may be NULL
 * @return MM_STATUS_OK, MM_STATUS_ABI_VERSION, MM_STATUS_STORAGE_SIZE, a MM_STATUS_PARAMETER_ status, MM_STATUS_RICCATI,
 *         MM_STATUS_REFUSED, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
 */
mm_status mm_controller_init(mm_controller *controller,
                             size_t size,
                             uint32_t abi_version,
                             const mm_params *params,
                             mm_problem *problem);

/**
 * Gives a controller other parameters and keeps its memory: integrals, what was learned, estimates, mode.
 *
 * What was learned stands for one update under another observer_bandwidth_1_s or robot, and is forgotten by a law that does not learn. Whether it is
 * supervised cannot change. On any status but MM_STATUS_OK it is as it was.
 *
 * @param[in,out] controller  an initialized controller
 * @param[in]     params      parameters; copied
 * @param[out]    problem     which parameter was refused, or an empty name; may be NULL
 * @return as mm_controller_init, and MM_STATUS_NOT_INITIALIZED, MM_STATUS_SUPERVISED or MM_STATUS_NOT_SUPERVISED
 */
mm_status mm_controller_retune(mm_controller *controller,
                               const mm_params *params,
                               mm_problem *problem);

/**
 * Forgets everything since the initialization: integrals, what was learned, estimates. A supervised controller runs again, from any mode.
 *
 * @param[in,out] controller  an initialized controller
 * @return MM_STATUS_OK, MM_STATUS_NOT_INITIALIZED, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
 */
mm_status mm_controller_reset(mm_controller *controller);

/**
 * One update from configuration and velocity: torques to hold for one period.
 *
 * Call it once every params.period_s; it has no clock of its own. Cost for MM_LAW_BFSMC: four sine and cosine pairs, about 600
 * multiplications and additions, ten divisions; no loop depends on data. On any status but MM_STATUS_OK the controller and
 * the outputs are as they were, and the caller holds a safe torque of its own choice.
 *
 * @param[in,out] controller  an initialized controller without supervisor
 * @param[in]     input       state of the robot and reference at this instant
 * @param[out]    output      torque and flags
 * @param[out]    signals     signals of the law; may be NULL
 * @return MM_STATUS_OK, MM_STATUS_CONFIGURATION_NOT_FINITE, MM_STATUS_VELOCITY_NOT_FINITE, MM_STATUS_REFERENCE_NOT_FINITE,
 *         MM_STATUS_OVERFLOW, MM_STATUS_SUPERVISED, MM_STATUS_NOT_INITIALIZED, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
 */
mm_status mm_controller_update(mm_controller *controller,
                               const mm_input *input,
                               mm_output *output,
                               mm_signals *signals);

/**
 * The same from measured positions: the estimator finds configuration and velocity first. The first update takes the velocity as zero.
 *
 * @param[in,out] controller   an initialized controller with estimator and without supervisor
 * @param[in]     measurement  what the sensors read, and the reference at this instant
 * @param[out]    output       torque and flags
 * @param[out]    signals      signals of the law, with the estimated velocity; may be NULL
 * @return as mm_controller_update, and MM_STATUS_WHEELS_NOT_FINITE or MM_STATUS_NO_ESTIMATOR
 */
mm_status mm_controller_update_measured(mm_controller *controller,
                                        const mm_measurement *measurement,
                                        mm_output *output,
                                        mm_signals *signals);

/**
 * One update under the supervisor: always a safe torque, whatever the numbers of timing and input are.
 *
 * An implausible, late or refused input is no status but a finding: the last torque is held, then the robot brought to rest. A status other
 * than MM_STATUS_OK means that the call itself was wrong.
 *
 * @param[in,out] controller  an initialized controller with params.supervised
 * @param[in]     timing      what the clock says
 * @param[in]     input       state of the robot and reference at this instant
 * @param[out]    command     torque, mode, findings, brake
 * @param[out]    signals     signals of the law, written where command.ran is 1; may be NULL
 * @return MM_STATUS_OK, MM_STATUS_NOT_SUPERVISED, MM_STATUS_NOT_INITIALIZED, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
 */
mm_status mm_controller_step(mm_controller *controller,
                             const mm_timing *timing,
                             const mm_input *input,
                             mm_command *command,
                             mm_signals *signals);

/**
 * The same from measured positions.
 *
 * @param[in,out] controller   an initialized controller with estimator and params.supervised
 * @param[in]     timing       what the clock says
 * @param[in]     measurement  what the sensors read, and the reference at this instant
 * @param[out]    command      torque, mode, findings, brake
 * @param[out]    signals      signals of the law, written where command.ran is 1; may be NULL
 * @return as mm_controller_step, and MM_STATUS_NO_ESTIMATOR
 */
mm_status mm_controller_step_measured(mm_controller *controller,
                                      const mm_timing *timing,
                                      const mm_measurement *measurement,
                                      mm_command *command,
                                      mm_signals *signals);

/**
 * The update of a period in which no input came: to be called from the loop, or from a watchdog, when the period is over.
 *
 * @param[in,out] controller  an initialized controller with params.supervised
 * @param[in]     timing      what the clock says; the age is not looked at
 * @param[out]    command     torque, mode, findings, brake
 * @return as mm_controller_step
 */
mm_status mm_controller_missed(mm_controller *controller,
                               const mm_timing *timing,
                               mm_command *command);

/**
 * Where a panic would end. It is never linked into a program.
 */
void mm_panic_reached(void);

/**
 * The same as mm_params_thesis in single precision.
 *
 * @copydetails mm_params_thesis
 */
mm_status mmf_params_thesis(mmf_params *params);

/**
 * The same as mm_params_defaults in single precision.
 *
 * @copydetails mm_params_defaults
 */
mm_status mmf_params_defaults(mmf_params *params, mm_problem *problem);

/**
 * The same as mm_controller_init in single precision.
 *
 * @copydetails mm_controller_init
 */
mm_status mmf_controller_init(mmf_controller *controller,
                              size_t size,
                              uint32_t abi_version,
                              const mmf_params *params,
                              mm_problem *problem);

/**
 * The same as mm_controller_retune in single precision.
 *
 * @copydetails mm_controller_retune
 */
mm_status mmf_controller_retune(mmf_controller *controller, const mmf_params *params, mm_problem *problem);

/**
 * The same as mm_controller_reset in single precision.
 *
 * @copydetails mm_controller_reset
 */
mm_status mmf_controller_reset(mmf_controller *controller);

/**
 * The same as mm_controller_update in single precision.
 *
 * @copydetails mm_controller_update
 */
mm_status mmf_controller_update(mmf_controller *controller,
                                const mmf_input *input,
                                mmf_output *output,
                                mmf_signals *signals);

/**
 * The same as mm_controller_update_measured in single precision.
 *
 * @copydetails mm_controller_update_measured
 */
mm_status mmf_controller_update_measured(mmf_controller *controller,
                                         const mmf_measurement *measurement,
                                         mmf_output *output,
                                         mmf_signals *signals);

/**
 * The same as mm_controller_step in single precision.
 *
 * @copydetails mm_controller_step
 */
mm_status mmf_controller_step(mmf_controller *controller,
                              const mmf_timing *timing,
                              const mmf_input *input,
                              mmf_command *command,
                              mmf_signals *signals);

/**
 * The same as mm_controller_step_measured in single precision.
 *
 * @copydetails mm_controller_step_measured
 */
mm_status mmf_controller_step_measured(mmf_controller *controller,
                                       const mmf_timing *timing,
                                       const mmf_measurement *measurement,
                                       mmf_command *command,
                                       mmf_signals *signals);

/**
 * The same as mm_controller_missed in single precision.
 *
 * @copydetails mm_controller_missed
 */
mm_status mmf_controller_missed(mmf_controller *controller, const mmf_timing *timing, mmf_command *command);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MM_CONTROL_H */

/** @cond */
#ifndef MM_CONTROL_ASSERTED_H
#define MM_CONTROL_ASSERTED_H
/* The library asserts the same sizes where it is built. */
#if defined(__cplusplus)
#define MM_ASSERT_(name, condition) static_assert(condition, #name)
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define MM_ASSERT_(name, condition) _Static_assert(condition, #name)
#else
#define MM_ASSERT_(name, condition) typedef char mm_assert_##name[(condition) ? 1 : -1]
#endif
MM_ASSERT_(double_has_64_bits, sizeof(double) == 8);
MM_ASSERT_(float_has_32_bits, sizeof(float) == 4);
MM_ASSERT_(size_of_controller, sizeof(mm_controller) == MM_CONTROLLER_SIZE);
MM_ASSERT_(size_of_controller_f, sizeof(mmf_controller) == MMF_CONTROLLER_SIZE);
MM_ASSERT_(size_of_robot, sizeof(mm_robot) == 392 && sizeof(mmf_robot) == 196);
MM_ASSERT_(size_of_params, sizeof(mm_params) == 1400 && sizeof(mmf_params) == 716);
MM_ASSERT_(size_of_input, sizeof(mm_input) == 160 && sizeof(mmf_input) == 80);
MM_ASSERT_(size_of_measurement, sizeof(mm_measurement) == 144 && sizeof(mmf_measurement) == 72);
MM_ASSERT_(size_of_timing, sizeof(mm_timing) == 16 && sizeof(mmf_timing) == 8);
MM_ASSERT_(size_of_output, sizeof(mm_output) == 48 && sizeof(mmf_output) == 24);
MM_ASSERT_(size_of_command, sizeof(mm_command) == 64 && sizeof(mmf_command) == 40);
MM_ASSERT_(size_of_signals, sizeof(mm_signals) == 424 && sizeof(mmf_signals) == 212);
#undef MM_ASSERT_
#endif /* MM_CONTROL_ASSERTED_H */
/** @endcond */
