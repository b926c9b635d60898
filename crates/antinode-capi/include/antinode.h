// antinode: the standing wave of a hemispherical resonator gyro, window by window, from its two pick-offs sampled together.
// Apache-2.0 or MIT. Made by cbindgen from crates/antinode-capi; do not edit.
//
//     static antinode_fixed_t gyro;                                     // or antinode_float_t, antinode_float_init and so on
//
//     antinode_settings_t settings = antinode_settings_default(100e3);  // before the interrupt is enabled
//     antinode_status_t status = antinode_fixed_init(&gyro, &settings); // below 0: antinode_status_string(status)
//
//     antinode_fixed_push_block_packed(&gyro, half_buffer, 128);        // in the interrupt of the converter's DMA
//
//     antinode_estimate_t estimate;                                     // in the thread, again and again
//     while (antinode_fixed_solve(&gyro, &estimate) == ANTINODE_ESTIMATE)
//         use(&estimate);
//
// Samples: S_C and S_D of pick-offs 45 degrees apart; the unit of amplitudes, offsets and residuals is that of the samples. The model
// for ideal pick-offs without offset, which gives the signs of angle, quadrature, phase and pick-off angle, is
//     S_C = A cos 2theta - B sin 2theta,   A = a_A cos tau,   tau = omega t - alpha, omega = 2pi f,
//     S_D = A sin 2theta + B cos 2theta,   B = a_B sin tau,   t = 0 at the window's middle.
// Codes are two's complement of 16 bits. Unsigned codes of up to 15 bits (a 12-bit converter, aligned to the right) go in as they are:
// their offset is found. Unsigned codes of 16 bits, oversampled or aligned to the left, would wrap around at half scale, and with
// `watch` 0 no flag shows it: invert the highest bits, word ^ 0x80008000, and subtract 32768 from the rails; offsets are then 32768 less.
//
// Memory: the caller provides each state, static or on a stack, aligned to 8 bytes as its type demands; there is no heap, no global
// and no callback. Zeroed memory is not an initialised state. A state may be copied or moved while nobody uses it.
//
// Concurrency, without a lock:
//  - Interrupt side: _push, _push_block*, _skip. One of them at a time: interrupts that call them must have the same priority. They
//    put finished blocks in a queue inside the state.
//  - Thread side: _solve, _search, _set_calibration. One of them at a time. They take blocks from the queue.
//  - One call of each side may be under way at the same time: the interrupt may break into the thread anywhere, or run on another core
//    that shares coherent memory.
//  - _health may be called from anywhere at any time except from another core during _init and _reset; the functions without a state
//    at any time.
//  - _init, _reset and _identify use both sides: no other call on that state may be under way, except _health during _identify, and,
//    during _init and _reset, those of an interrupt of the same core, which are refused.
//  - States are independent of each other.
//
// Cost of the interrupt:
//  - Instructions a sample pair with thumbv7em-none-eabihf: 200 to 460 during the search for a period, up to 700 over a half-buffer of
//    the first block after it, or of a signal that looks like a wave but is not, such as two tones; afterwards 10 to 80, or 70 to 180 with
//    _push. These are means: a single _push may take 2000 during the search, and 1150 (fixed) or 2150 (float) afterwards; half-buffers
//    never take that many a pair.
//  - Without a floating-point unit: during the search, in noise (and the most seen over a half-buffer of 128 pairs; in a single _push)
//        thumbv7em-none-eabi   fixed 1760 (4370; 19100)   float 6600 (8940; 23000)
//        thumbv7m-none-eabi    fixed 2060 (4680; 19400)   float 6600 (8940; 23000)
//        thumbv6m-none-eabi    fixed 3860 (9040; 38600)   float 12400 (16800; 45000)
//    At 100 kHz this is more than such a core can do, and the thread gets no time while there is no wave: give `frequency_hz`, with which
//    a pair takes 21, 119 and 209 (float 1190, 1180 and 2180), over the first half-buffer up to 1130, 1220 and 3430 (float 2410, 2390 and
//    5200); or, at rates that leave time for half-buffers of up to 1950, 1950 and 4080 (float 2390, 2380 and 5180),
//    ANTINODE_DETECTION_MEAN_RETURN.
//  - Stack: with thumbv7em-none-eabihf up to 0.8 KiB, or 1.0 KiB (fixed) or 1.3 KiB (float) with _push_block; with another archive up to
//    1.2 KiB, or 1.5 or 1.8 KiB with _push_block.
//  - Floating-point registers: if the core has them, the search and the first block use them, even in fixed point. What saves them for
//    threads must save them for this interrupt too (lazy stacking; Zephyr: CONFIG_FPU_SHARING).
//
// Errors: a NULL or misaligned pointer, a state that is not initialised and a value out of range give a status below 0, and nothing is
// done; but a state whose _init failed is no longer initialised. A pointer that is neither NULL nor misaligned must point to what its
// type says; a state must be changed by these functions only. Any sample is valid, NaN included. No function then panics, aborts or
// blocks. Floating-point exceptions must be masked, as they are in C unless a program unmasks them (Free Pascal and Delphi do): the flags
// for division by zero, invalid operation and overflow are set in ordinary use, and are no sign of a fault.


#ifndef ANTINODE_H
#define ANTINODE_H

#include <stddef.h>
#include <stdint.h>

// The shortest period that is searched for, sample pairs. If no frequency is given, a wave whose period is not between this and
// ANTINODE_LONGEST_PERIOD is not found, unless sampling folds it to one that is. Then there is no estimate, and no flag and no status
// shows why; only `has_wave` of antinode_health_t, which stays 0, shows it: watch it.
#define ANTINODE_SHORTEST_PERIOD 4

// The longest period, sample pairs.
#define ANTINODE_LONGEST_PERIOD 200

// The most periods a window may have.
#define ANTINODE_MOST_PERIODS 50

// Finished blocks that the queue holds, including the one being solved. A block is two periods long, or a fifth of a window if that is
// less; with a hop, half of this. It has at most ANTINODE_LONGEST_PERIOD sample pairs, and may be a little shorter, so that whole blocks
// fit a window. At most ANTINODE_QUEUE_BLOCKS - 1 blocks should be finished between two calls of a `_solve` function, and by one call of
// a `_push_block` function: at 18.75 samples a period, 15 blocks are 540 pairs in windows of ten periods and more, but 90 in windows of
// two.
#define ANTINODE_QUEUE_BLOCKS 16

// 64-bit words of an `antinode_fixed_t`.
#define ANTINODE_FIXED_WORDS 1104

// 64-bit words of an `antinode_float_t`.
#define ANTINODE_FLOAT_WORDS 1352

// Samples at the converter's rail, flattened crests, or the third harmonic that a limiter leaves: amplitudes are wrong.
#define ANTINODE_FLAG_CLIPPED 1u

// No significant wave: no number of the estimate means anything, and some may be NaN or infinite.
#define ANTINODE_FLAG_LOST 2u

// The phase does not continue that of the last window without LOST, MISFIT, DEAD_CHANNEL and NOT_FINITE: samples are missing since that
// one or within this.
#define ANTINODE_FLAG_PHASE_JUMP 4u

// Amplitude, angle or offset stepped between the previous window and this one.
#define ANTINODE_FLAG_STEP 8u

// Main and quadrature amplitude are about equal: the pattern is circular and the angle has no meaning.
#define ANTINODE_FLAG_CIRCULAR 16u

// The samples are not one wave with steady rates plus noise: there is a step, a dropout or a second tone within the window.
#define ANTINODE_FLAG_MISFIT 32u

// A pick-off gave a constant value, though before its wave was larger than `resolution`, or lost its wave while the other kept it. Half of
// such losses are flagged if the lost wave exceeded 0.4 % of the main amplitude by 20 standard deviations of an amplitude between windows,
// or by 30 within one, and all if by 30 or 55. After a new search a dead pick-off looks like a pattern on the other pick-off's axis, and
// is not flagged.
#define ANTINODE_FLAG_DEAD_CHANNEL 64u

// The angle is known modulo pi/2 only: set on the first window after a lost wave was searched for, or after a gap, misfits or circular
// windows in which the pattern may have turned unseen, and on the first window after a new calibration, unless it is the first of all. The
// flag stays set up to and including the first window without MISFIT, NOT_FINITE and DEAD_CHANNEL, whose angle later windows continue.
#define ANTINODE_FLAG_REACQUIRED 128u

// A sample is NaN or infinite, or so large that its sums are not finite.
#define ANTINODE_FLAG_NOT_FINITE 256u

// The period is found from the squared difference, in about three periods, with offsets of up to 100 amplitudes, and in noise of 20 % and
// more.
#define ANTINODE_DETECTION_DIFFERENCE 0u

// The period is found from the return of the running sum, in about eleven periods; for signals with little noise.
#define ANTINODE_DETECTION_MEAN_RETURN 1u

// The version of this header: major x 65536 + minor x 256 + patch.
#define ANTINODE_HEADER_VERSION 256u

// What a function returns: zero or above if it was done; below zero if it failed and nothing was done.
enum
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
    antinode_status_t : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Done.
    ANTINODE_OK = 0,
    // Done, and a block was finished: it waits for a `_solve` function.
    ANTINODE_READY = 1,
    // Done, and an estimate was written.
    ANTINODE_ESTIMATE = 2,
    // Done, and blocks wait as after ANTINODE_READY; but the queue was full, and at least one finished block was dropped, which leaves a
    // gap as a `_skip` function does. Call `_solve` more often, or push fewer pairs at once: see ANTINODE_QUEUE_BLOCKS.
    ANTINODE_DROPPED = 3,
    // A pointer is NULL.
    ANTINODE_ERROR_NULL = -1,
    // A pointer is not aligned as its type demands.
    ANTINODE_ERROR_ALIGNMENT = -2,
    // The state was never initialised, its last `_init` failed, or it belongs to the other arithmetic. In memory that a reset does not
    // clear, a state from before it, perhaps half written, counts as initialised: enable the interrupt after `_init`.
    ANTINODE_ERROR_NOT_INITIALISED = -3,
    // An array would be larger than the address space.
    ANTINODE_ERROR_COUNT = -4,
    // `sample_rate_hz` is not within 1 to 1e10.
    ANTINODE_ERROR_SAMPLE_RATE = -10,
    // `periods` is not within 2 to ANTINODE_MOST_PERIODS.
    ANTINODE_ERROR_PERIODS = -11,
    // `hop_blocks` is not within 0 to 65535.
    ANTINODE_ERROR_HOP = -12,
    // `start_angle_rad` is not within +-10000.
    ANTINODE_ERROR_START_ANGLE = -13,
    // `rail_low` is not below `rail_high`.
    ANTINODE_ERROR_RAILS = -14,
    // `resolution` is neither 0 nor a positive number.
    ANTINODE_ERROR_RESOLUTION = -15,
    // `detection` is not one of ANTINODE_DETECTION_*.
    ANTINODE_ERROR_DETECTION = -16,
    // `watch` is neither 0 nor 1.
    ANTINODE_ERROR_WATCH = -17,
    // `gain_ratio` is not within 0.1 to 10.
    ANTINODE_ERROR_GAIN_RATIO = -18,
    // `skew_s` is not within +-0.001.
    ANTINODE_ERROR_SKEW = -19,
    // `pick_off_angle_rad` is not within +-0.3.
    ANTINODE_ERROR_PICK_OFF_ANGLE = -20,
    // `hum` is neither 0 nor 1, or windows with it have fewer than 5 periods, or 10 with a hop.
    ANTINODE_ERROR_HUM = -21,
    // `frequency_hz` is neither 0 nor within `sample_rate_hz` / ANTINODE_LONGEST_PERIOD, or half a sample pair more, to
    // `sample_rate_hz` / 2.5.
    ANTINODE_ERROR_FREQUENCY = -22,
    // `coloured` is neither 0 nor 1.
    ANTINODE_ERROR_COLOURED = -23,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum antinode_status_t antinode_status_t;
#else
typedef int32_t antinode_status_t;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// State of an identification in fixed point, on `int16_t` codes. Opaque: only the functions `antinode_fixed_*` look inside.
typedef struct antinode_fixed_t {
    uint64_t words[ANTINODE_FIXED_WORDS];
} antinode_fixed_t;

// How pick-off D differs from an ideal one that stands 45 degrees from C, has C's gain and is sampled with C.
typedef struct antinode_calibration_t {
    // Gain of channel D over that of channel C. 0.1 to 10; 1 is ideal.
    float gain_ratio;
    // How much later channel D is sampled than channel C, s. Within +-0.001; 0 is ideal. If it is more than a tenth of a window, the
    // uncertainty of the frequency adds to those of a_B and the angle, and the stated deviations do not include it.
    float skew_s;
    // Pick-off D stands at 45 degrees plus this angle from C, rad. Within +-0.3; 0 is ideal.
    float pick_off_angle_rad;
} antinode_calibration_t;

// Settings of an identification. Start from antinode_settings_default() and change what differs.
typedef struct antinode_settings_t {
    // Sample rate, Hz. 1 to 1e10.
    double sample_rate_hz;
    // Length of a window, periods. 2 to ANTINODE_MOST_PERIODS; default 10. A window is a whole number of blocks, a block a whole number of
    // samples: so the length may be off by up to a tenth, with `hum` a ninth, and by more if a known frequency has few samples a period: 2
    // periods of 2.6 samples become 2.31.
    uint32_t periods;
    // Blocks from the start of one window to the start of the next, 1 to 65535; a block is then about a period, or a tenth of a window of
    // less than ten periods, rounded to whole samples: 0.87 to 1.33 periods if these are short. For windows that follow each other without
    // gap or overlap give 0, the default, not the number of periods.
    uint32_t hop_blocks;
    // The first window's angle is chosen within pi/4 of this angle, rad. Within +-10000: subtract whole turns from a greater one. Default
    // pi/4, which puts the first angle in 0 to pi/2.
    float start_angle_rad;
    // The least value that the converter gives, input units: a window with a sample at or below it is flagged as clipped. Default 0, as
    // for a converter with unsigned codes.
    float rail_low;
    // The greatest value that the converter gives, input units, above `rail_low`: 4095 for 12 bits. Both rails 0, the default: not known.
    float rail_high;
    // Step between neighbouring codes of the converter, input units, > 0: standard deviations then include the error of rounding to it. 0,
    // the default: not known. In noise of less than 0.3 of a step, errors may then be many times the standard deviations, and windows
    // without a fault be flagged ANTINODE_FLAG_CLIPPED or ANTINODE_FLAG_MISFIT: give it.
    float resolution;
    // The wave's frequency, Hz, if it is known, and stays so, within 5 %: it is then never searched for, and the first window begins with
    // the first sample. `sample_rate_hz` / ANTINODE_LONGEST_PERIOD to `sample_rate_hz` / 2.5; 0, the default: the period is found as
    // `detection` says.
    float frequency_hz;
    // How the period is found: ANTINODE_DETECTION_DIFFERENCE, the default, or ANTINODE_DETECTION_MEAN_RETURN.
    uint32_t detection;
    // 1, the default: the third harmonic and the extremes of the samples are watched. 0: they are not, which about halves the work at
    // sample rate; ANTINODE_FLAG_CLIPPED is then never set, ANTINODE_FLAG_DEAD_CHANNEL only when a wave is lost, and ANTINODE_FLAG_MISFIT
    // hardly ever for a second tone or a wave at another frequency.
    uint32_t watch;
    // How the pick-offs differ from ideal ones. Default: ideal.
    struct antinode_calibration_t calibration;
    // 1 if the signals carry hum or another slow wander: each block, of 0.9 periods or more, then has an offset of its own, and what only
    // moves offsets is neither noise nor a fault. Windows must then have at least 5 periods, or 10 with a hop. 0, the default: they do
    // not.
    uint32_t hum;
    // 1 if the noise is not white. Behind a tuned front end, or a filter that cuts off below three times the wave's frequency, noise at
    // three times the frequency has less than a sixteenth of its power about the wave: with this setting that is no fault, and blocks have
    // offsets of their own, as with `hum`. In return, what is in every window is not flagged: a second tone counts as noise, and so does a
    // fault in the first window. 0, the default: the noise is white.
    uint32_t coloured;
} antinode_settings_t;

// The wave over one window, at the window's middle. Each `_std` is one standard deviation.
typedef struct antinode_estimate_t {
    // Index in the stream of the window's first sample pair: pairs pushed and pairs skipped before it, since `_init` or `_reset`.
    uint64_t start;
    // Time of the window's middle, s from the stream's first sample, pushed or skipped.
    double time_s;
    // Pattern angle theta, rad: it begins near the start angle, and is continued from window to window.
    double angle_rad;
    // Resonant frequency f, Hz.
    double frequency_hz;
    // Sample pairs in the window.
    uint32_t samples;
    // What is wrong with the window: a sum of ANTINODE_FLAG_* bits; 0 when clean.
    uint32_t flags;
    // Amplitude a_A of the main standing wave, > 0, input units.
    float main_amplitude;
    // Amplitude a_B of the quadrature wave, signed, at most a_A, input units.
    float quadrature_amplitude;
    // Phase alpha, rad, -pi to pi: the main wave is a_A cos(2pif*(t - time_s) - alpha).
    float phase_rad;
    // Precession of the pattern dtheta/dt, rad/s, from this window alone.
    float angle_rate_rad_s;
    // Decay rate -(da_A/dt)/a_A, 1/s: positive while the wave decays.
    float decay_rate_s;
    // Offset of S_C, input units.
    float offset_c;
    // Offset of S_D as sampled, input units: before `gain_ratio` is applied.
    float offset_d;
    // Standard deviation of a_A, input units.
    float main_amplitude_std;
    // Standard deviation of a_B, input units.
    float quadrature_amplitude_std;
    // Standard deviation of theta, rad.
    float angle_std_rad;
    // Standard deviation of alpha, rad.
    float phase_std_rad;
    // Standard deviation of f, Hz.
    float frequency_std_hz;
    // Standard deviation of dtheta/dt, rad/s.
    float angle_rate_std_rad_s;
    // Standard deviation of the decay rate, 1/s.
    float decay_rate_std_s;
    // Rms of the residual, which is what the wave does not explain, per sample and channel, input units: it equals the noise if that is
    // white. S_D counts as sampled: before `gain_ratio` is applied.
    float residual_rms;
    // Always 0: the struct ends at a multiple of eight bytes on every machine.
    uint32_t reserved;
} antinode_estimate_t;

// How an identification is doing, from counters that either side may read.
typedef struct antinode_health_t {
    // 1 while a period is searched for, 0 while blocks are gathered; always 0 if `frequency_hz` is given.
    uint32_t searching;
    // 1 once a window that shows a wave has been solved, until one that shows none, or `_search`. If it stays 0 there is no wave, or none
    // with a period that is searched for, or none at the frequency given: nothing else shows this.
    uint32_t has_wave;
    // Finished blocks that wait to be solved, 0 to ANTINODE_QUEUE_BLOCKS.
    uint32_t waiting;
    // Finished blocks dropped since the start because the queue was full; it wraps.
    uint32_t dropped;
} antinode_health_t;

// State of an identification in single precision. Opaque: only the functions `antinode_float_*` look inside.
typedef struct antinode_float_t {
    uint64_t words[ANTINODE_FLOAT_WORDS];
} antinode_float_t;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The size of an `antinode_fixed_t` in the library that is linked, bytes. May be called from anywhere.
size_t antinode_fixed_size(void);

// The size of an `antinode_float_t` in the library that is linked, bytes. May be called from anywhere.
size_t antinode_float_size(void);

// Initialises a state from cold. Returns ANTINODE_OK, or what is wrong with the settings; the state is then not initialised. Call it
// before any other function, while neither side runs. Only an interrupt of the same core may break in; ANTINODE_ERROR_NOT_INITIALISED
// tells it that its pairs were not taken. To go on with other settings call it again, with the last angle as `start_angle_rad` and the
// last frequency as `frequency_hz`, so that no search is needed; no other wave is then found. Times begin at 0 again.
antinode_status_t antinode_fixed_init(struct antinode_fixed_t *state,
                                      const struct antinode_settings_t *settings);

// Returns a state to what it was after its initialisation, except for the calibration, which is kept. It may be called when
// antinode_fixed_init() may.
antinode_status_t antinode_fixed_reset(struct antinode_fixed_t *state);

// Interrupt side. Takes one sample pair, converter codes. Returns ANTINODE_OK; ANTINODE_READY if the pair finished a block;
// ANTINODE_DROPPED if that block had to be dropped.
antinode_status_t antinode_fixed_push(struct antinode_fixed_t *state, int16_t c, int16_t d);

// Interrupt side. Takes `count` sample pairs from two arrays, converter codes. Returns the same as antinode_fixed_push().
antinode_status_t antinode_fixed_push_block(struct antinode_fixed_t *state, const int16_t *c, const int16_t *d, size_t count);

// Interrupt side. Takes `count` sample pairs from one array of 2 x `count` samples, C and D in turn, converter codes. Returns the same as
// antinode_fixed_push(). Pairs are read as words: if the core traps unaligned words (CCR.UNALIGN_TRP), `samples` must begin at a multiple
// of four bytes.
antinode_status_t antinode_fixed_push_block_interleaved(struct antinode_fixed_t *state,
                                                        const int16_t *samples,
                                                        size_t count);

// Interrupt side. Takes `count` sample pairs of 16-bit codes, C in the low half of a word and D in the high half, as a dual
// converter's DMA leaves them; pass unsigned codes of 16 bits as `word ^ 0x80008000`, see the head of the header. Returns the same as
// antinode_fixed_push().
antinode_status_t antinode_fixed_push_block_packed(struct antinode_fixed_t *state,
                                                   const uint32_t *words,
                                                   size_t count);

// Interrupt side. Reports that `count` sample pairs were lost before the next one: the window that they would have been part of is
// dropped, and `start` and `time_s` of later windows count them, even if no pair was pushed yet. After a gap so long that the turn of the
// pattern meanwhile is known to no better than 0.13 rad (one standard deviation), the angle is known modulo pi/2 only, and
// ANTINODE_FLAG_REACQUIRED says so.
antinode_status_t antinode_fixed_skip(struct antinode_fixed_t *state,
                                      uint32_t count);

// Thread side. Solves finished blocks up to the next estimate. Returns ANTINODE_ESTIMATE if one was written: there may then be more.
// Returns ANTINODE_OK if no block is left, or if ANTINODE_QUEUE_BLOCKS blocks gave no estimate: `estimate` is then unchanged. A lost wave
// is searched for anew without a call. Estimates come in order of time: a full queue keeps its oldest blocks, so the first estimates after
// a stall of this side are as old as the stall, and no flag shows it. Compare `start` + `samples` with a count of the pairs pushed and
// skipped.
antinode_status_t antinode_fixed_solve(struct antinode_fixed_t *state,
                                       struct antinode_estimate_t *estimate);

// Thread side. Drops the wave and searches anew; the angle continues from the last one, modulo pi/2.
antinode_status_t antinode_fixed_search(struct antinode_fixed_t *state);

// Thread side. Changes the calibration from the next block on; the window begun is dropped, and the next one is flagged
// ANTINODE_FLAG_REACQUIRED. A calibration out of range changes nothing.
antinode_status_t antinode_fixed_set_calibration(struct antinode_fixed_t *state,
                                                 const struct antinode_calibration_t *calibration);

// Either side. Reads the state of the identification: whether it searches, has a wave, and loses blocks.
antinode_status_t antinode_fixed_health(const struct antinode_fixed_t *state, struct antinode_health_t *health);

// Both sides in one call, for use without an interrupt: takes sample pairs from `samples`, C and D in turn, up to the end of a window, and
// writes how many it took to `taken`. Returns ANTINODE_ESTIMATE if a window ended and its estimate was written: call it again with the
// rest. Returns ANTINODE_OK if all `count` pairs were taken without an estimate. `samples` must be aligned as for
// antinode_fixed_push_block_interleaved().
antinode_status_t antinode_fixed_identify(struct antinode_fixed_t *state,
                                          const int16_t *samples,
                                          size_t count,
                                          size_t *taken,
                                          struct antinode_estimate_t *estimate);

// Initialises a state from cold. Returns ANTINODE_OK, or what is wrong with the settings; the state is then not initialised. Call it
// before any other function, while neither side runs. Only an interrupt of the same core may break in; ANTINODE_ERROR_NOT_INITIALISED
// tells it that its pairs were not taken. To go on with other settings call it again, with the last angle as `start_angle_rad` and the
// last frequency as `frequency_hz`, so that no search is needed; no other wave is then found. Times begin at 0 again.
antinode_status_t antinode_float_init(struct antinode_float_t *state,
                                      const struct antinode_settings_t *settings);

// Returns a state to what it was after its initialisation, except for the calibration, which is kept. It may be called when
// antinode_float_init() may.
antinode_status_t antinode_float_reset(struct antinode_float_t *state);

// Interrupt side. Takes one sample pair, in any unit. Returns ANTINODE_OK; ANTINODE_READY if the pair finished a block; ANTINODE_DROPPED
// if that block had to be dropped.
antinode_status_t antinode_float_push(struct antinode_float_t *state,
                                      float c,
                                      float d);

// Interrupt side. Takes `count` sample pairs from two arrays, in any unit. Returns the same as antinode_float_push().
antinode_status_t antinode_float_push_block(struct antinode_float_t *state, const float *c, const float *d, size_t count);

// Interrupt side. Takes `count` sample pairs from one array of 2 x `count` samples, C and D in turn, in any unit. Returns the same as
// antinode_float_push().
antinode_status_t antinode_float_push_block_interleaved(struct antinode_float_t *state,
                                                        const float *samples,
                                                        size_t count);

// Interrupt side. Takes `count` sample pairs of 16-bit codes, C in the low half of a word and D in the high half, as a dual
// converter's DMA leaves them; pass unsigned codes of 16 bits as `word ^ 0x80008000`, see the head of the header. Returns the same as
// antinode_float_push().
antinode_status_t antinode_float_push_block_packed(struct antinode_float_t *state,
                                                   const uint32_t *words,
                                                   size_t count);

// Interrupt side. Reports that `count` sample pairs were lost before the next one: the window that they would have been part of is
// dropped, and `start` and `time_s` of later windows count them, even if no pair was pushed yet. After a gap so long that the turn of the
// pattern meanwhile is known to no better than 0.13 rad (one standard deviation), the angle is known modulo pi/2 only, and
// ANTINODE_FLAG_REACQUIRED says so.
antinode_status_t antinode_float_skip(struct antinode_float_t *state,
                                      uint32_t count);

// Thread side. Solves finished blocks up to the next estimate. Returns ANTINODE_ESTIMATE if one was written: there may then be more.
// Returns ANTINODE_OK if no block is left, or if ANTINODE_QUEUE_BLOCKS blocks gave no estimate: `estimate` is then unchanged. A lost wave
// is searched for anew without a call. Estimates come in order of time: a full queue keeps its oldest blocks, so the first estimates after
// a stall of this side are as old as the stall, and no flag shows it. Compare `start` + `samples` with a count of the pairs pushed and
// skipped.
antinode_status_t antinode_float_solve(struct antinode_float_t *state,
                                       struct antinode_estimate_t *estimate);

// Thread side. Drops the wave and searches anew; the angle continues from the last one, modulo pi/2.
antinode_status_t antinode_float_search(struct antinode_float_t *state);

// Thread side. Changes the calibration from the next block on; the window begun is dropped, and the next one is flagged
// ANTINODE_FLAG_REACQUIRED. A calibration out of range changes nothing.
antinode_status_t antinode_float_set_calibration(struct antinode_float_t *state,
                                                 const struct antinode_calibration_t *calibration);

// Either side. Reads the state of the identification: whether it searches, has a wave, and loses blocks.
antinode_status_t antinode_float_health(const struct antinode_float_t *state, struct antinode_health_t *health);

// Both sides in one call, for use without an interrupt: takes sample pairs from `samples`, C and D in turn, up to the end of a window, and
// writes how many it took to `taken`. Returns ANTINODE_ESTIMATE if a window ended and its estimate was written: call it again with the
// rest. Returns ANTINODE_OK if all `count` pairs were taken without an estimate.
antinode_status_t antinode_float_identify(struct antinode_float_t *state,
                                          const float *samples,
                                          size_t count,
                                          size_t *taken,
                                          struct antinode_estimate_t *estimate);

// Settings with every default: windows of 10 periods that follow each other, ideal pick-offs, no known rails, everything watched.
// The sample rate is checked by the `_init` functions. May be called from anywhere.
struct antinode_settings_t antinode_settings_default(double sample_rate_hz);

// What a status means, in English; never NULL. Takes any number. May be called from anywhere.
const char *antinode_status_string(int32_t status);

// The version of the library that is linked. ANTINODE_HEADER_VERSION may differ from it in the last eight bits, the patch, which changes no
// type and no function; otherwise header and library do not belong together. Compare the size of a state too, which depends on how the
// library was built, before its `_init`. May be called from anywhere.
uint32_t antinode_version(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* ANTINODE_H */
