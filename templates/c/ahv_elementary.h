/* Elementary functions of the generated models, in C99: double precision, the bits of the Rust crate `ahv-core`.
 *
 * Every function is pure: no global state, no heap, no errno. Of the platform's libm only `sqrt` is called, by
 * `ahv_sqrt`; IEEE 754 rounds it correctly (link with -lm where the platform asks for it).
 *
 * The bits hold under three conditions. This header refuses a compilation that is known to break the first two.
 *   1. A double is an IEEE 754 binary64, and an operation on doubles is rounded to a double at once.
 *   2. No optimisation changes the value of an expression: no -ffast-math, -Ofast or the like.
 *   3. A product and a sum are not contracted into a fused multiply-add: compile with -ffp-contract=off. The macro
 *      AHV_NO_CONTRACTION is a second safeguard, from within a source file.
 * At run time the rounding mode is to nearest, and subnormal numbers are not flushed to zero: the defaults of C.
 */
#ifndef AHV_ELEMENTARY_H
#define AHV_ELEMENTARY_H

#include <float.h>

#if (FLT_RADIX != 2) || (DBL_MANT_DIG != 53) || (DBL_MAX_EXP != 1024) || (DBL_MIN_EXP != -1021)
#error "ahv: a double must be an IEEE 754 binary64"
#endif

/* 0, 1 and 16 evaluate doubles as doubles; 2, the x87 unit, does not. Before C99 there is no such macro. */
#ifndef FLT_EVAL_METHOD
#error "ahv: FLT_EVAL_METHOD is not defined; compile as C99 or C++11, or later"
#elif (FLT_EVAL_METHOD != 0) && (FLT_EVAL_METHOD != 1) && (FLT_EVAL_METHOD != 16)
#error "ahv: doubles must be evaluated as doubles (FLT_EVAL_METHOD 0); on x86 compile with -msse2 -mfpmath=sse"
#endif

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || defined(_M_FP_FAST)
#error "ahv: -ffast-math, -Ofast and the like change results; compile without them"
#endif

#ifdef __FINITE_MATH_ONLY__
#if __FINITE_MATH_ONLY__ > 0
#error "ahv: -ffinite-math-only changes results; compile without it"
#endif
#endif

/* Stands at the head of a source file, outside functions. gcc has not the standard pragma but one of its own; and its
 * vectorisers fuse products and sums even with -ffp-contract=off, as gcc 12 does at -O3 -mfma. */
#if defined(__GNUC__) && !defined(__clang__)
#define AHV_NO_CONTRACTION \
    _Pragma("GCC optimize (\"-ffp-contract=off\", \"-fno-tree-slp-vectorize\", \"-fno-tree-loop-vectorize\")")
#else
#define AHV_NO_CONTRACTION _Pragma("STDC FP_CONTRACT OFF")
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* e to the power x, to less than 1 ulp of a normal result. Infinity above about 709.78, subnormal below about
 * -708.40, 0 below about -745.13; NaN of NaN. */
double ahv_exp(double x);

/* Sine and cosine of an angle in rad, each to less than 1 ulp; they share the reduction of the angle. Any finite
 * angle; NaN of infinity and NaN. The sine of -0 is +0. `sine` and `cosine` must not be null. */
void ahv_sin_cos(double angle, double *sine, double *cosine);

/* The sine that `ahv_sin_cos` gives. */
double ahv_sin(double angle);

/* The cosine that `ahv_sin_cos` gives. */
double ahv_cos(double angle);

/* Tangent of an angle in rad, to less than 1 ulp up to 1e6 rad; beyond, the quotient of sine and cosine. NaN of infinity
 * and NaN. */
double ahv_tan(double angle);

/* Inverse sine in rad, from -pi/2 to pi/2, to less than 1 ulp; NaN beyond -1 and 1. */
double ahv_asin(double x);

/* Inverse tangent in rad, from -pi/2 to pi/2, to less than 1 ulp. */
double ahv_atan(double x);

/* Angle in rad, from -pi to pi, of the point with the ordinate y and the abscissa x, to less than 1 ulp. */
double ahv_atan2(double y, double x);

/* Hyperbolic tangent, to less than 1 ulp. */
double ahv_tanh(double x);

/* Natural logarithm, to less than 1 ulp; minus infinity of zero, NaN below. */
double ahv_ln(double x);

/* x to a real power, e to the power of `exponent` times the logarithm, to less than 1 ulp: the powr of IEEE 754, NaN
 * below zero. */
double ahv_powr(double x, double exponent);

/* Absolute value. */
double ahv_abs(double x);

/* `below` where x is below `bound`, else `otherwise`; NaN where x or `bound` is. */
double ahv_select(double x, double bound, double below, double otherwise);

/* The smaller and the larger of two numbers; NaN if one is. */
double ahv_min(double x, double y);
double ahv_max(double x, double y);

/* Square root, correctly rounded; NaN below zero, -0 of -0. */
double ahv_sqrt(double x);

/* 1/x, correctly rounded. */
double ahv_recip(double x);

#ifdef __cplusplus
}
#endif

#endif
