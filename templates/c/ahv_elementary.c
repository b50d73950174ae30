/* Sine, cosine and exponential, from additions and multiplications alone.
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

/* Sine and cosine of a moderate angle. */
static void reduced_sin_cos(double x, double *sine, double *cosine) {
    const double shifted = (x * TWO_OVER_PI) + ROUNDER;
    const double turns = shifted - ROUNDER;
    const double coarse = x - (turns * HALF_PI[0]);
    const double step = turns * HALF_PI[1];
    const double middle = coarse - step;
    const double low_step = turns * HALF_PI[2];
    /* Next to a multiple of pi/2 both differences are exact, else what they lose joins the small terms. */
    const double high = middle - low_step;
    const double lost = ((coarse - middle) - step) + ((middle - high) - low_step);
    const double low = lost - (turns * HALF_PI[3]);
    const double rest = high + low;
    kernel(rest, (high - rest) + low, sine, cosine);
    turn(to_bits(shifted), sine, cosine);
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

/* e^x for |x| <= 708. */
static double moderate_exp(double x) {
    const double *c = EXP;
    const double shifted = (x * LOG2_E) + ROUNDER;
    const double doublings = shifted - ROUNDER;
    const double high = x - (doublings * LN_2[0]);
    const double step = doublings * LN_2[1];
    const double r = high - step;
    const double low = (high - r) - step;
    const double r_2 = r * r;
    const double r_4 = r_2 * r_2;
    const double first = (c[0] + (c[1] * r)) + (r_2 * (c[2] + (c[3] * r)));
    const double last = ((c[4] + (c[5] * r)) + (r_2 * (c[6] + (c[7] * r)))) + (r_4 * (c[8] + (c[9] * r)));
    const double p = first + (r_4 * last);
    const double fraction = 1.0 + (r + (low + (r_2 * p)));
    /* The low bits hold the exponent; those above them fall off. */
    return fraction * from_bits((to_bits(shifted) + 1023U) << 52U);
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
