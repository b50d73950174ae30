/* Elementary functions, from additions, multiplications and divisions alone.
 *
 * For |angle| <= 1e6 rad and |exponent| <= 708 the operations are those of `ahv-core`, one by one. Beyond, `ahv-core`
 * calls the Rust crate `libm`, which follows FreeBSD's msun. The code for these ranges is written anew so that it
 * rounds as msun does; it takes over msun's coefficients and split constants. Their notice:
 *
 *   Copyright (C) 1993, 2004 by Sun Microsystems, Inc. All rights reserved.
 *   Developed at SunPro, a Sun Microsystems, Inc. business. Permission to use, copy, modify, and distribute this
 *   software is freely granted, provided that this notice is preserved.
 *
 * Decimal constants have 17 digits or name a double exactly: a compiler that rounds them correctly gives these bits.
 */
#include "ahv_elementary.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

AHV_NO_CONTRACTION

/* pi/4 and 2/pi */
static const double QUARTER_PI = 0.78539816339744831;
static const double TWO_OVER_PI = 0.63661977236758138;

/* 1/ln 2 */
static const double LOG2_E = 1.4426950408889634;

/* (sin x - x)/x^3 as a polynomial in x^2 for |x| <= pi/4; relative error of sin x 2^-57. */
static const double SIN[6] = {
    -0.16666666666666644,  0.008333333333324425,   -0.00019841269831056066,
    2.755731404725958e-06, -2.505080550019054e-08, 1.5899196851420854e-10,
};

/* (cos x - 1 + x^2/2)/x^4 as a polynomial in x^2 for |x| <= pi/4; relative error of cos x 2^-63. */
static const double COS[6] = {
    0.04166666666666665,     -0.0013888888888881452, 2.480158729341395e-05,
    -2.7557315352291386e-07, 2.0875845106254155e-09, -1.1365380407353296e-11,
};

/* (e^r - 1 - r)/r^2 as a polynomial in r for |r| <= ln 2/2; relative error of e^r 2^-56. */
static const double EXP[10] = {
    0.5000000000000011,     0.16666666666666413,    0.041666666666530155,   0.008333333333494465,
    0.0013888888943630188,  0.00019841269506571267, 2.4801493098816138e-05, 2.75575863808365e-06,
    2.763024841408471e-07,  2.500005928835836e-08,
};

/* pi/2 in parts of 33 bits and the rest, so that a whole multiple of a part below 2^20 is exact. */
static const double HALF_PI[4] = {
    1.5707963267341256,
    6.077100506303966e-11,
    2.0222662487111665e-21,
    8.4784276603689e-32,
};

/* ln 2 in parts of 33 bits and the rest. */
static const double LN_2[2] = {0.6931471804855391, 7.440617110012397e-11};

/* Adding 1.5 * 2^52 rounds to a whole number and leaves it in the low bits. */
static const double ROUNDER = 6755399441055744.0;

/* Those of a NaN are above. */
static const uint64_t INFINITY_BITS = UINT64_C(0x7FF0000000000000);

/* Larger angles and exponents go the ways of msun. */
static const double LARGEST_ANGLE = 1e6;
static const double LARGEST_EXPONENT = 708.0;

/* The bits of a double, and back. A copy, because an access through a pointer of another type is undefined. */
static uint64_t to_bits(double x) {
    uint64_t bits;
    (void)memcpy(&bits, &x, sizeof bits);
    return bits;
}

static double from_bits(uint64_t bits) {
    double x;
    (void)memcpy(&x, &bits, sizeof x);
    return x;
}

static double magnitude(double x) {
    return from_bits(to_bits(x) & UINT64_C(0x7FFFFFFFFFFFFFFF));
}

static double not_a_number(void) {
    return from_bits(UINT64_C(0x7FF8000000000000));
}

/* 2^exponent, a normal number. */
static double power_of_two(int32_t exponent) {
    return from_bits((uint64_t)(1023 + (int64_t)exponent) << 52U);
}

/* The exponent of a normal number whose magnitude is in [2^exponent, 2^(exponent + 1)). */
static int32_t exponent_of(double x) {
    return (int32_t)((to_bits(x) >> 52U) & 0x7FFU) - 1023;
}

/* --- Angles up to 1e6 rad --------------------------------------------------------------------------------------- */

/* A polynomial of six coefficients by Estrin's scheme: three short chains instead of a long one. */
static double cubic_pairs(const double c[6], double z, double z_2) {
    return (c[0] + (c[1] * z)) + (z_2 * ((c[2] + (c[3] * z)) + (z_2 * (c[4] + (c[5] * z)))));
}

/* Sine and cosine of x + low for |x| <= pi/4 and a low far smaller than x. */
static void kernel(double x, double low, double *sine, double *cosine) {
    const double x_2 = x * x;
    const double x_4 = x_2 * x_2;
    const double sin_series = cubic_pairs(SIN, x_2, x_4);
    const double cos_series = cubic_pairs(COS, x_2, x_4);
    /* What 1 - x^2/2 loses by rounding joins the small terms. */
    const double half = 0.5 * x_2;
    const double main_part = 1.0 - half;
    *sine = x + (((x * x_2) * sin_series) + low);
    *cosine = main_part + (((1.0 - main_part) - half) + ((x_4 * cos_series) - (x * low)));
}

/* Sine and cosine of an angle, given those of the angle less `quarters` quarter turns. */
static void turn(uint64_t quarters, double *sine, double *cosine) {
    /* A quarter turn swaps the two and turns the sign of the new cosine; a half turn turns both signs. */
    const uint64_t swapped = UINT64_C(0) - (quarters & 1U);
    const uint64_t s = to_bits(*sine);
    const uint64_t c = to_bits(*cosine);
    const uint64_t exchange = (s ^ c) & swapped;
    const uint64_t sign_sine = (quarters & 2U) << 62U;
    const uint64_t sign_cosine = ((quarters + 1U) & 2U) << 62U;
    *sine = from_bits((s ^ exchange) ^ sign_sine);
    *cosine = from_bits((c ^ exchange) ^ sign_cosine);
}

/* A moderate angle less a number of quarter turns, as *rest + *low; that number in the low bits. */
static uint64_t reduced_angle(double x, double *rest, double *low) {
    const double shifted = (x * TWO_OVER_PI) + ROUNDER;
    const double turns = shifted - ROUNDER;
    const double coarse = x - (turns * HALF_PI[0]);
    const double step = turns * HALF_PI[1];
    const double middle = coarse - step;
    const double low_step = turns * HALF_PI[2];
    /* Next to a multiple of pi/2 both differences are exact, else what they lose joins the small terms. */
    const double high = middle - low_step;
    const double lost = ((coarse - middle) - step) + ((middle - high) - low_step);
    const double last = lost - (turns * HALF_PI[3]);
    *rest = high + last;
    *low = (high - *rest) + last;
    return to_bits(shifted);
}

/* Sine and cosine of a moderate angle. */
static void reduced_sin_cos(double x, double *sine, double *cosine) {
    double rest;
    double low;
    const uint64_t quarters = reduced_angle(x, &rest, &low);
    kernel(rest, low, sine, cosine);
    turn(quarters, sine, cosine);
}

/* --- Angles above 1e6 rad, rounded as in msun ------------------------------------------------------------------- */

/* Below these bits, those of 2^20 * pi/2 without the last 32, the parts of pi/2 suffice for the reduction. */
static const uint64_t LARGEST_BY_PARTS = UINT64_C(0x413921FB00000000);

/* The rests of pi/2 less one, two and three of its parts of 33 bits. */
static const double REST_OF_HALF_PI[3] = {6.0771005065061922e-11, 2.0222662487959506e-21, 8.4784276603689e-32};

/* Digits of 24 bits: a product of two and a sum of five such are exact in 64 bits and in a double. */
#define DIGIT_BITS 24
#define DIGIT_BASE UINT64_C(0x1000000)
#define DIGIT_MASK UINT64_C(0xFFFFFF)

/* Digits of 2/pi after the point: at most position 41, of the largest double, and 8 more are read. */
#define TWO_OVER_PI_DIGITS_COUNT 50
static const uint32_t TWO_OVER_PI_DIGITS[TWO_OVER_PI_DIGITS_COUNT] = {
    0xA2F983U, 0x6E4E44U, 0x1529FCU, 0x2757D1U, 0xF534DDU, 0xC0DB62U, 0x95993CU, 0x439041U, 0xFE5163U, 0xABDEBBU,
    0xC561B7U, 0x246E3AU, 0x424DD2U, 0xE00649U, 0x2EEA09U, 0xD1921CU, 0xFE1DEBU, 0x1CB129U, 0xA73EE8U, 0x8235F5U,
    0x2EBB44U, 0x84E99CU, 0x7026B4U, 0x5F7E41U, 0x3991D6U, 0x398353U, 0x39F49CU, 0x845F8BU, 0xBDF928U, 0x3B1FF8U,
    0x97FFDEU, 0x05980FU, 0xEF2F11U, 0x8B5A0AU, 0x6D1F6DU, 0x367ECFU, 0x27CB09U, 0xB74F46U, 0x3F669EU, 0x5FEA2DU,
    0x7527BAU, 0xC7EBE5U, 0xF17B3DU, 0x0739F7U, 0x8A5292U, 0xEA6BFBU, 0x5FB11FU, 0x8D5D08U, 0x560330U, 0x46FC7BU,
};

/* Digits of pi/2; the first has the weight 2^-23. */
#define HALF_PI_DIGITS_COUNT 5
static const uint32_t HALF_PI_DIGITS[HALF_PI_DIGITS_COUNT] = {0xC90FDAU, 0xA22168U, 0xC234C4U, 0xC6628BU, 0x80DC1CU};

/* Digits that are kept after the first of a fraction that is not 0. */
#define FOLLOWING_DIGITS 4
/* No double is so near to a multiple of pi/2 that more than 62 bits of the fraction are 0: at most three digits. The
 * bound of 8 is never reached; it keeps every index inside its array. */
#define LAST_DIGIT 8

/* An angle less `quarters` quarter turns, as high + low; quarters modulo 8. */
typedef struct {
    uint64_t quarters;
    double high;
    double low;
} Reduced;

/* The fraction of angle * 2/pi by digits. Digit 0 has the weight 2^exponent and may have up to 27 bits. */
typedef struct {
    uint64_t digits[LAST_DIGIT + 1];
    int32_t last;
    int32_t exponent;
    uint64_t quarters;
    int is_negative;
} Fraction;

/* Takes parts of pi/2 away until what is left has 53 bits. */
static Reduced reduced_by_parts(double x) {
    const double shifted = (x * TWO_OVER_PI) + ROUNDER;
    const double turns = shifted - ROUNDER;
    const int32_t exponent = exponent_of(x);
    double rest = x - (turns * HALF_PI[0]);
    double step = turns * REST_OF_HALF_PI[0];
    Reduced reduced = {0U, 0.0, 0.0};
    reduced.quarters = to_bits(shifted);
    reduced.high = rest - step;
    /* Bits that cancelled so far, against those that one and two parts of pi/2 allow for. */
    if ((exponent - exponent_of(reduced.high)) > 16) {
        double before = rest;
        step = turns * HALF_PI[1];
        rest = before - step;
        step = (turns * REST_OF_HALF_PI[1]) - ((before - rest) - step);
        reduced.high = rest - step;
        if ((exponent - exponent_of(reduced.high)) > 49) {
            before = rest;
            step = turns * HALF_PI[2];
            rest = before - step;
            step = (turns * REST_OF_HALF_PI[2]) - ((before - rest) - step);
            reduced.high = rest - step;
        }
    }
    reduced.low = (rest - reduced.high) - step;
    return reduced;
}

/* Digits 0 to `last` of angle * 2/pi. Digits of 2/pi before `position` - 2 would add multiples of 8 and are left out.
 * Digit 0 keeps what is above 24 bits. */
static void multiply_digits(
    const uint64_t angle[3],
    int32_t position,
    int32_t last,
    uint64_t digits[LAST_DIGIT + 1]) {
    uint64_t sum = 0U;
    for (int32_t i = last; i >= 0; i--) {
        for (int32_t j = 0; j < 3; j++) {
            const int32_t index = position + i - j;
            if ((index >= 0) && (index < TWO_OVER_PI_DIGITS_COUNT)) {
                sum += angle[j] * TWO_OVER_PI_DIGITS[index];
            }
        }
        if (i > 0) {
            digits[i] = sum & DIGIT_MASK;
            sum /= DIGIT_BASE;
        } else {
            digits[i] = sum;
        }
    }
}

/* Splits digits into whole quarters and the fraction; a fraction from 1/2 on becomes 1 less the fraction, negative,
 * and a quarter more. */
static void split_quarters(Fraction *number) {
    /* Digits 0 and 1 in one: the point stands in either. What falls off are multiples of 8 quarters. */
    const uint32_t fraction_bits = (uint32_t)(DIGIT_BITS - number->exponent);
    const uint64_t one = UINT64_C(1) << fraction_bits;
    uint64_t head = (number->digits[0] * DIGIT_BASE) + number->digits[1];
    number->quarters = head >> fraction_bits;
    head &= one - 1U;
    number->is_negative = ((head >> (fraction_bits - 1U)) != 0U) ? 1 : 0;
    if (number->is_negative != 0) {
        uint64_t borrow = 0U;
        for (int32_t i = number->last; i > 1; i--) {
            const uint64_t difference = (DIGIT_BASE - number->digits[i]) - borrow;
            number->digits[i] = difference & DIGIT_MASK;
            borrow = (difference < DIGIT_BASE) ? 1U : 0U;
        }
        head = (one - head) - borrow;
        number->quarters += 1U;
    }
    number->digits[0] = head / DIGIT_BASE;
    number->digits[1] = head & DIGIT_MASK;
}

/* Index of the first digit that is not 0, or of the last. */
static int32_t first_digit(const Fraction *number) {
    int32_t first = 0;
    while ((first < number->last) && (number->digits[first] == 0U)) {
        first++;
    }
    return first;
}

/* The fraction times pi/2, from its digit `first` on, as a sum of two doubles. */
static Reduced times_half_pi(const Fraction *number, int32_t first) {
    uint64_t digits[LAST_DIGIT + 2] = {0U};
    double parts[LAST_DIGIT + 2] = {0.0};
    int32_t count = 0;
    int32_t exponent = number->exponent - (DIGIT_BITS * first);
    Reduced reduced = {0U, 0.0, 0.0};
    for (int32_t i = first; i <= number->last; i++) {
        if (number->digits[i] >= DIGIT_BASE) {
            digits[count] = number->digits[i] / DIGIT_BASE;
            count++;
            exponent += DIGIT_BITS;
        }
        digits[count] = number->digits[i] & DIGIT_MASK;
        count++;
    }
    for (int32_t i = 0; i < count; i++) {
        uint64_t sum = 0U;
        for (int32_t k = 0; (k < HALF_PI_DIGITS_COUNT) && (k <= i); k++) {
            sum += HALF_PI_DIGITS[k] * digits[i - k];
        }
        /* Exact: below 2^51 and far from the subnormal numbers. */
        parts[i] = (double)sum * power_of_two((exponent - 23) - (DIGIT_BITS * i));
    }
    /* The smallest first; then what the sum has lost. */
    for (int32_t i = count - 1; i >= 0; i--) {
        reduced.high += parts[i];
    }
    reduced.low = parts[0] - reduced.high;
    for (int32_t i = 1; i < count; i++) {
        reduced.low += parts[i];
    }
    return reduced;
}

/* The reduction of Payne and Hanek: of x * 2/pi only those digits are computed that the result depends on. */
static Reduced reduced_by_digits(double x) {
    /* x is a whole number of 72 bits, of which 53 can differ from 0, times 2^(exponent - 71). */
    const int32_t exponent = exponent_of(x);
    const uint64_t mantissa = (to_bits(x) & UINT64_C(0xFFFFFFFFFFFFF)) | (UINT64_C(1) << 52U);
    const uint64_t angle[3] = {mantissa >> 29U, (mantissa >> 5U) & DIGIT_MASK, (mantissa & 0x1FU) << 19U};
    /* Digits of 2/pi that lie wholly before this place add multiples of 8 quarters. */
    const int32_t position = (exponent > 26) ? ((exponent - 26) / DIGIT_BITS) : 0;
    Fraction number = {{0U}, 0, 0, 0U, 0};
    int32_t first = 0;
    int32_t last = FOLLOWING_DIGITS;
    Reduced reduced;
    number.exponent = (exponent - 23) - (DIGIT_BITS * (position + 1));
    /* More digits, until enough follow the first that is not 0. */
    do {
        number.last = last;
        multiply_digits(angle, position, last, number.digits);
        split_quarters(&number);
        first = first_digit(&number);
        last = ((first + FOLLOWING_DIGITS) < LAST_DIGIT) ? (first + FOLLOWING_DIGITS) : LAST_DIGIT;
    } while (last > number.last);
    reduced = times_half_pi(&number, first);
    reduced.quarters = number.quarters;
    if (number.is_negative != 0) {
        reduced.high = -reduced.high;
        reduced.low = -reduced.low;
    }
    return reduced;
}

/* Sine of x + low for |x| <= pi/4, in the order of msun. */
static double large_angle_sin(double x, double low) {
    const double z = x * x;
    const double w = z * z;
    const double v = z * x;
    const double middle = 0.0083333333333224895 + (z * (-0.00019841269829857949 + (z * 2.7557313707070068e-06)));
    const double series = middle + ((z * w) * (-2.5050760253406863e-08 + (z * 1.5896909952115501e-10)));
    return x - (((z * ((0.5 * low) - (v * series))) - low) - (v * -0.16666666666666632));
}

/* Cosine of x + low for |x| <= pi/4, in the order of msun. */
static double large_angle_cos(double x, double low) {
    const double z = x * x;
    const double w = z * z;
    const double first = z * (0.041666666666666602 + (z * (-0.0013888888888874110 + (z * 2.4801587289476729e-05))));
    const double last = -2.7557314351390663e-07 + (z * (2.0875723212981748e-09 + (z * -1.1359647557788195e-11)));
    const double series = first + ((w * w) * last);
    const double half = 0.5 * z;
    const double main_part = 1.0 - half;
    return main_part + (((1.0 - main_part) - half) + ((z * series) - (x * low)));
}

/* Sine and cosine of an angle above 1e6 rad, infinity or NaN. */
static void large_angle_sin_cos(double x, double *sine, double *cosine) {
    const double size = magnitude(x);
    Reduced reduced;
    if (to_bits(size) >= INFINITY_BITS) {
        *sine = not_a_number();
        *cosine = not_a_number();
        return;
    }
    reduced = (to_bits(size) < LARGEST_BY_PARTS) ? reduced_by_parts(size) : reduced_by_digits(size);
    *sine = large_angle_sin(reduced.high, reduced.low);
    *cosine = large_angle_cos(reduced.high, reduced.low);
    turn(reduced.quarters, sine, cosine);
    if (x < 0.0) {
        *sine = -*sine;
    }
}

/* --- Exponential ------------------------------------------------------------------------------------------------ */

/* 2 to the power of what the low bits hold; those above them fall off. */
static double power_of_low_bits(uint64_t doublings) {
    return from_bits((doublings + 1023U) << 52U);
}

/* A moderate exponent less a number of ln 2, as *rest + *low; that number in the low bits. */
static uint64_t reduced_exponent(double x, double *rest, double *low) {
    const double shifted = (x * LOG2_E) + ROUNDER;
    const double doublings = shifted - ROUNDER;
    const double high = x - (doublings * LN_2[0]);
    const double step = doublings * LN_2[1];
    *rest = high - step;
    *low = (high - *rest) - step;
    return to_bits(shifted);
}

/* e^r - 1 - r */
static double exp_tail(double r) {
    const double *c = EXP;
    const double r_2 = r * r;
    const double r_4 = r_2 * r_2;
    const double first = (c[0] + (c[1] * r)) + (r_2 * (c[2] + (c[3] * r)));
    const double last = ((c[4] + (c[5] * r)) + (r_2 * (c[6] + (c[7] * r)))) + (r_4 * (c[8] + (c[9] * r)));
    return r_2 * (first + (r_4 * last));
}

/* e^x for |x| <= 708. */
static double moderate_exp(double x) {
    double r;
    double low;
    const uint64_t doublings = reduced_exponent(x, &r, &low);
    const double fraction = 1.0 + (r + (low + exp_tail(r)));
    return fraction * power_of_low_bits(doublings);
}

/* e^x for |x| > 708, where the result leaves the normal numbers, rounded as in msun. */
static double extreme_exp(double x) {
    int32_t doublings = 0;
    double high = 0.0;
    double low = 0.0;
    double r = 0.0;
    double z = 0.0;
    double c = 0.0;
    double fraction = 0.0;
    if (x > 709.78271289338397) {
        return x * power_of_two(1023);
    }
    if (x < -745.13321910194111) {
        return 0.0;
    }
    doublings = (int32_t)((LOG2_E * x) + ((x < 0.0) ? -0.5 : 0.5));
    high = x - ((double)doublings * 0.69314718036912382);
    low = (double)doublings * 1.9082149292705877e-10;
    r = high - low;
    z = r * r;
    c = -1.6533902205465252e-06 + (z * 4.1381367970572385e-08);
    c = -0.0027777777777015593 + (z * (6.6137563214379344e-05 + (z * c)));
    c = r - (z * (0.16666666666666602 + (z * c)));
    fraction = 1.0 + ((((r * c) / (2.0 - c)) - low) + high);
    /* In two steps: 2^doublings may be no double. Only the second can round. */
    return (fraction * power_of_two(doublings / 2)) * power_of_two(doublings - (doublings / 2));
}

/* --- Sums of two doubles, for what a result needs beyond the precision of one ------------------------------------- */

typedef struct {
    double high;
    double low;
} Pair;

static Pair exact(double high) {
    const Pair pair = {high, 0.0};
    return pair;
}

/* a + b without an error, for |a| >= |b| or a = 0. */
static Pair ordered_sum(double a, double b) {
    Pair sum;
    sum.high = a + b;
    sum.low = (a - sum.high) + b;
    return sum;
}

/* a + b without an error. */
static Pair exact_sum(double a, double b) {
    Pair sum;
    double back;
    sum.high = a + b;
    back = sum.high - a;
    sum.low = (a - (sum.high - back)) + (b - back);
    return sum;
}

/* A number as a sum of two of 26 bits, whose products are exact. */
static Pair halves(double x) {
    const double shifted = x * 134217729.0;
    Pair both;
    both.high = shifted - (shifted - x);
    both.low = x - both.high;
    return both;
}

/* a * b without an error, for factors below 2^996 and a product that is not tiny. */
static Pair exact_product(double a, double b) {
    const Pair of_a = halves(a);
    const Pair of_b = halves(b);
    Pair product;
    product.high = a * b;
    product.low = (of_a.high * of_b.high) - product.high;
    product.low = (product.low + (of_a.high * of_b.low)) + (of_a.low * of_b.high);
    product.low = product.low + (of_a.low * of_b.low);
    return product;
}

static Pair negative(Pair a) {
    const Pair turned = {-a.high, -a.low};
    return turned;
}

static Pair plus(Pair a, Pair b) {
    const Pair sum = exact_sum(a.high, b.high);
    return ordered_sum(sum.high, sum.low + (a.low + b.low));
}

static Pair times(Pair a, Pair b) {
    const Pair product = exact_product(a.high, b.high);
    const double cross = (a.high * b.low) + (a.low * b.high);
    return ordered_sum(product.high, product.low + cross);
}

/* The quotient, its low part as a correction of the high one. */
static Pair over(Pair a, Pair b) {
    Pair quotient;
    Pair back;
    double rest;
    quotient.high = a.high / b.high;
    back = exact_product(quotient.high, b.high);
    rest = ((a.high - back.high) - back.low) + (a.low - (quotient.high * b.low));
    quotient.low = rest / b.high;
    return quotient;
}

/* --- Tangent and hyperbolic tangent ------------------------------------------------------------------------------- */

/* 2^-30: a smaller angle is its own tangent. */
static const double TINY_ANGLE = 9.313225746154785e-10;

/* Above, the hyperbolic tangent is 1. */
static const double LARGEST_OF_TANH = 20.0;

/* (e^r - 1 - r - r^2/2)/r^3 as a polynomial in r for |r| <= ln 2/2; relative error of e^r - 1 2^-60. */
static const double EXP_LESS_ONE[10] = {
    0.16666666666666677,   0.04166666666666669,    0.008333333333321695,   0.0013888888888870217,
    0.00019841269885985402, 2.4801587355967003e-05, 2.755724433650261e-06, 2.7557245702065875e-07,
    2.510899601613109e-08, 2.0923721907815714e-09,
};

/* The magnitude of one number with the sign of another. */
static double with_sign(double size, double sign) {
    const uint64_t sign_bit = UINT64_C(0x8000000000000000);
    return from_bits((to_bits(size) & ~sign_bit) | (to_bits(sign) & sign_bit));
}

/* Sine and cosine of x + low for |x| <= pi/4 and a low far smaller than x, to about 2^-56 of themselves. */
static void kernel_pairs(double x, double low, Pair *sine, Pair *cosine) {
    const Pair square = exact_product(x, x);
    const double x_2 = square.high;
    const double x_4 = x_2 * x_2;
    const double half = 0.5 * x_2;
    const double sin_rest = ((x * x_2) * cubic_pairs(SIN, x_2, x_4)) + (low - (low * half));
    const Pair main_part = ordered_sum(1.0, -half);
    const double small = (x_4 * cubic_pairs(COS, x_2, x_4)) - ((x * low) + (0.5 * square.low));
    *sine = ordered_sum(x, sin_rest);
    *cosine = ordered_sum(main_part.high, main_part.low + small);
}

/* The tangent of a moderate angle. */
static double moderate_tan(double x) {
    double rest;
    double low;
    Pair sine;
    Pair cosine;
    Pair quotient;
    const uint64_t quarters = reduced_angle(x, &rest, &low);
    kernel_pairs(rest, low, &sine, &cosine);
    /* A quarter turn makes of the tangent the inverse one, with the other sign. */
    quotient = ((quarters & 1U) != 0U) ? over(negative(cosine), sine) : over(sine, cosine);
    return (magnitude(x) < TINY_ANGLE) ? x : (quotient.high + quotient.low);
}

/* e^x - 1 for 0 <= x <= 40. */
static Pair exp_less_one(double x) {
    const double *c = EXP_LESS_ONE;
    double r;
    double low;
    const uint64_t doublings = reduced_exponent(x, &r, &low);
    const Pair square = exact_product(r, r);
    const double r_2 = square.high;
    const double r_4 = r_2 * r_2;
    const double first = (c[0] + (c[1] * r)) + (r_2 * (c[2] + (c[3] * r)));
    const double last = ((c[4] + (c[5] * r)) + (r_2 * (c[6] + (c[7] * r)))) + (r_4 * (c[8] + (c[9] * r)));
    const double p = first + (r_4 * last);
    const Pair half = ordered_sum(r, 0.5 * r_2);
    const double rest = half.low + ((0.5 * square.low) + (((r * r_2) * p) + (low + (low * r))));
    const Pair near_one = ordered_sum(half.high, rest);
    const double scale = power_of_low_bits(doublings);
    const Pair scaled = {scale * near_one.high, scale * near_one.low};
    return plus(exact(scale - 1.0), scaled);
}

/* --- Inverse tangents and sine ------------------------------------------------------------------------------------ */

/* (atan t - t)/t^3 as a polynomial in t^2 for |t| <= tan(pi/8); relative error of atan t 2^-59. */
static const double ARC[11] = {
    -0.3333333333333327,  0.19999999999969428, -0.14285714281496567, 0.1111111083893405,
    -0.09090899160250497, 0.07692082604182458, -0.0666333588676279,  0.05849443556842783,
    -0.05045815083558404, 0.03821944304783067, -0.01806697503803219,
};

/* tan(pi/8) and tan(3 pi/8): between them the angle is counted from pi/4. */
static const double MIDDLE[2] = {0.41421356237309503, 2.414213562373095};

/* pi/2, 3 pi/4 and pi; what pi/4 exceeds its double by, and of the others it is as many times this. */
static const double HALF_TURN_OF_TWO = 1.5707963267948966;
static const double THREE_QUARTERS_PI = 2.356194490192345;
static const double WHOLE_PI = 3.141592653589793;
static const double REST_OF_QUARTER_PI = 3.061616997868383e-17;

/* 2^-250: a smaller tangent is its own angle, and its quotient needs no correction. Above 2^60 the angle is pi/2. */
static const double TINY_TANGENT = 5.527147875260445e-76;
static const double LARGEST_TANGENT = 1152921504606846976.0;

/* 2^900, 2^-60, 2^-700 and 2^250. */
static const double LARGE_SIDE = 8.452712498170644e270;
static const double SHRINK = 8.673617379884035e-19;
static const double SMALL_SIDE = 1.90109156629516e-211;
static const double GROW_SIDE = 1.8092513943330656e75;

/* The polynomial ARC by Estrin's scheme. */
static double arc_polynomial(double z) {
    const double *c = ARC;
    const double z_2 = z * z;
    const double z_4 = z_2 * z_2;
    const double first = (c[0] + (c[1] * z)) + (z_2 * (c[2] + (c[3] * z)));
    const double second = (c[4] + (c[5] * z)) + (z_2 * (c[6] + (c[7] * z)));
    const double third = (c[8] + (c[9] * z)) + (z_2 * c[10]);
    return first + (z_4 * (second + (z_4 * third)));
}

/* The angle of the point (x, y) of the first quadrant; if `is_mirrored` that of (-x, y). */
static double angle_of(double y, Pair x, int is_mirrored) {
    const int is_steep = (y > (MIDDLE[1] * x.high)) ? 1 : 0;
    const int is_middle = (y > (MIDDLE[0] * x.high)) ? 1 : 0;
    const Pair upright = exact(y);
    const double sign = (is_mirrored != 0) ? -1.0 : 1.0;
    double from = (is_mirrored != 0) ? WHOLE_PI : 0.0;
    double quarters = (is_mirrored != 0) ? 4.0 : 0.0;
    Pair quotient;
    Pair main_part;
    double t;
    double z;
    double correction;
    double rest;
    if (is_steep != 0) {
        quotient = over(negative(x), upright);
        from = HALF_TURN_OF_TWO;
        quarters = 2.0;
    } else if (is_middle != 0) {
        quotient = over(plus(upright, negative(x)), plus(upright, x));
        from = (is_mirrored != 0) ? THREE_QUARTERS_PI : QUARTER_PI;
        quarters = (is_mirrored != 0) ? 3.0 : 1.0;
    } else {
        quotient = over(upright, x);
    }
    t = quotient.high;
    correction = (magnitude(t) > TINY_TANGENT) ? quotient.low : 0.0;
    z = t * t;
    rest = ((t * z) * arc_polynomial(z)) + (correction - (correction * z));
    main_part = ordered_sum(from, sign * t);
    return main_part.high + (main_part.low + ((quarters * REST_OF_QUARTER_PI) + (sign * rest)));
}

/* --- Logarithm and powers ----------------------------------------------------------------------------------------- */

/* (artanh s - s - s^3/3 - s^5/5)/s^7 as a polynomial in s^2 for |s| <= (sqrt 2 - 1)/(sqrt 2 + 1); relative error of
 * artanh s 2^-69. */
static const double ARTANH[7] = {
    0.14285714285714476, 0.11111111110907367,  0.09090909156695835,  0.07692298149609836,
    0.06667385264202787, 0.058532070065899694, 0.058634603904658064,
};

/* 1/3 and 1/5 */
static const Pair THIRD = {0.3333333333333333, 1.850371707708594e-17};
static const Pair FIFTH = {0.19999999999999998, 1.6653345369377347e-17};

static const double ROOT_OF_TWO = 1.4142135623730951;

/* 2^54 makes a normal number of every subnormal one. */
static const double GROW = 18014398509481984.0;
static const double SMALLEST_NORMAL = 2.2250738585072014e-308;

/* The bits of 2^52, whose last ones count units. */
static const uint64_t COUNTER = UINT64_C(0x4330000000000000);
static const double COUNTED = 4503599627370496.0;

/* Larger exponents of a power give 0 or infinity. */
static const double LARGEST_POWER = 1000.0;
static const double BEYOND = 800.0;

/* The logarithm to about 2^-67 of itself. */
static Pair logarithm(double x) {
    const double *c = ARTANH;
    const int is_subnormal = (x < SMALLEST_NORMAL) ? 1 : 0;
    const double grown = (is_subnormal != 0) ? (x * GROW) : x;
    const double lacking = (is_subnormal != 0) ? 1077.0 : 1023.0;
    const uint64_t bits = to_bits(grown);
    double doublings = (from_bits(COUNTER | ((bits >> 52U) & 0x7FFU)) - COUNTED) - lacking;
    double mantissa = from_bits((bits & UINT64_C(0xFFFFFFFFFFFFF)) | UINT64_C(0x3FF0000000000000));
    Pair s;
    Pair square;
    Pair series;
    Pair half;
    Pair of_mantissa;
    Pair of_doublings;
    double z;
    double z_2;
    double polynomial;
    if (!(x > 0.0) || (to_bits(x) == INFINITY_BITS)) {
        const double edge = (x == 0.0) ? -from_bits(INFINITY_BITS) : not_a_number();
        return exact((to_bits(x) == INFINITY_BITS) ? x : edge);
    }
    if (mantissa > ROOT_OF_TWO) {
        mantissa = 0.5 * mantissa;
        doublings = doublings + 1.0;
    }
    /* ln m = 2 artanh((m - 1)/(m + 1)) */
    s = over(exact(mantissa - 1.0), exact_sum(mantissa, 1.0));
    square = times(s, s);
    z = square.high;
    z_2 = z * z;
    polynomial = (c[4] + (c[5] * z)) + (z_2 * c[6]);
    polynomial = ((c[0] + (c[1] * z)) + (z_2 * (c[2] + (c[3] * z)))) + ((z_2 * z_2) * polynomial);
    series = times(square, plus(FIFTH, exact(z * polynomial)));
    series = times(square, plus(THIRD, series));
    half = plus(s, times(s, series));
    of_mantissa.high = 2.0 * half.high;
    of_mantissa.low = 2.0 * half.low;
    of_doublings.high = doublings * LN_2[0];
    of_doublings.low = doublings * LN_2[1];
    return plus(of_doublings, of_mantissa);
}

/* e to the power high + low, also where it leaves the normal numbers. */
static double exp_of_sum(double high, double low) {
    const double below = (high > BEYOND) ? BEYOND : high;
    const double moderate = (below < -BEYOND) ? -BEYOND : below;
    double r;
    double lost;
    const uint64_t doublings = reduced_exponent(moderate, &r, &lost);
    /* The low part may be as large as the last bit of `high`. */
    const Pair rest = ordered_sum(r, lost + low);
    const Pair main_part = ordered_sum(1.0, rest.high);
    const double fraction = main_part.high + (main_part.low + (exp_tail(rest.high) + rest.low));
    /* In two steps, of which only the second can round. */
    const uint64_t half = (((doublings + 2048U) & 0xFFFU) >> 1U) - 1024U;
    return (fraction * power_of_low_bits(half)) * power_of_low_bits(doublings - half);
}

/* --- What the header offers ------------------------------------------------------------------------------------- */

double ahv_exp(double x) {
    const double size = magnitude(x);
    double result;
    if (size <= LARGEST_EXPONENT) {
        result = moderate_exp(x);
    } else if (to_bits(size) > INFINITY_BITS) {
        result = not_a_number();
    } else {
        result = extreme_exp(x);
    }
    return result;
}

void ahv_sin_cos(double angle, double *sine, double *cosine) {
    const double size = magnitude(angle);
    if (size <= QUARTER_PI) {
        kernel(angle, 0.0, sine, cosine);
    } else if (size <= LARGEST_ANGLE) {
        reduced_sin_cos(angle, sine, cosine);
    } else {
        large_angle_sin_cos(angle, sine, cosine);
    }
}

double ahv_sin(double angle) {
    double sine;
    double cosine;
    ahv_sin_cos(angle, &sine, &cosine);
    return sine;
}

double ahv_cos(double angle) {
    double sine;
    double cosine;
    ahv_sin_cos(angle, &sine, &cosine);
    return cosine;
}

double ahv_sqrt(double x) {
    /* The library's function would set errno below zero. */
    return (x < 0.0) ? not_a_number() : sqrt(x);
}

double ahv_recip(double x) {
    return 1.0 / x;
}

double ahv_tan(double angle) {
    double sine;
    double cosine;
    if (magnitude(angle) <= LARGEST_ANGLE) {
        return moderate_tan(angle);
    }
    large_angle_sin_cos(angle, &sine, &cosine);
    return sine / cosine;
}

double ahv_asin(double x) {
    const Pair square = exact_product(x, x);
    Pair rest = ordered_sum(1.0, -square.high);
    Pair root;
    Pair back;
    double missing;
    rest = ordered_sum(rest.high, rest.low - square.low);
    root.high = ahv_sqrt(rest.high);
    back = exact_product(root.high, root.high);
    missing = ((rest.high - back.high) - back.low) + rest.low;
    root.low = (root.high == 0.0) ? 0.0 : (missing / (2.0 * root.high));
    return with_sign(angle_of(magnitude(x), root, 0), x);
}

double ahv_atan(double x) {
    const double size = magnitude(x);
    return with_sign(angle_of((size > LARGEST_TANGENT) ? LARGEST_TANGENT : size, exact(1.0), 0), x);
}

double ahv_atan2(double y, double x) {
    const double size_y = magnitude(y);
    const double size_x = magnitude(x);
    const double larger = (size_y > size_x) ? size_y : size_x;
    const int is_mirrored = ((to_bits(x) >> 63U) != 0U) ? 1 : 0;
    double scale = 1.0;
    double height;
    double distance;
    /* No sum of the two overflows, no correction of a quotient underflows; a number that is lost here is far below the
     * other. */
    if (larger > LARGE_SIDE) {
        scale = SHRINK;
    } else if (larger < SMALL_SIDE) {
        scale = GROW_SIDE;
    }
    height = size_y * scale;
    distance = (larger == 0.0) ? 1.0 : (size_x * scale);
    if ((to_bits(size_y) == INFINITY_BITS) && (to_bits(size_x) == INFINITY_BITS)) {
        height = 1.0;
        distance = 1.0;
    }
    return with_sign(angle_of(height, exact(distance), is_mirrored), y);
}

double ahv_tanh(double x) {
    const double size = magnitude(x);
    const Pair less_one = exp_less_one(2.0 * ((size > LARGEST_OF_TANH) ? LARGEST_OF_TANH : size));
    const Pair quotient = over(less_one, plus(less_one, exact(2.0)));
    return with_sign((size < TINY_ANGLE) ? size : (quotient.high + quotient.low), x);
}

double ahv_ln(double x) {
    const Pair found = logarithm(x);
    return found.high + found.low;
}

double ahv_powr(double x, double exponent) {
    const Pair of_base = logarithm(x);
    const double high = exponent * of_base.high;
    const Pair product = exact_product(exponent, of_base.high);
    const double low = product.low + (exponent * of_base.low);
    /* Beyond an exponent of 10^300 only the logarithm 0 gives a moderate product, and the low parts are no numbers. */
    return exp_of_sum(high, ((magnitude(high) < LARGEST_POWER) && (magnitude(exponent) < 1e300)) ? low : 0.0);
}

double ahv_abs(double x) {
    return magnitude(x);
}

double ahv_select(double x, double bound, double below, double otherwise) {
    double chosen = not_a_number();
    if (x >= bound) {
        chosen = otherwise;
    }
    if (x < bound) {
        chosen = below;
    }
    return chosen;
}

double ahv_min(double x, double y) {
    return ahv_select(x, y, x, y);
}

double ahv_max(double x, double y) {
    return ahv_select(x, y, y, x);
}
