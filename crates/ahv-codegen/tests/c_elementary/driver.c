/* Reads doubles from standard input and writes the results of each to standard output, in the machine's byte order: exp,
 * sin, cos, both of sin_cos, sqrt, recip, tan, asin, atan, tanh, ln, abs; then those of two, the other being as far from the
 * end of its block as the one from the beginning: atan2, powr, min, max, select. */
#include "ahv_elementary.h"

#include <stdio.h>

#define BLOCK 4096
#define RESULTS 18

int main(void) {
    static double values[BLOCK];
    static double results[BLOCK][RESULTS];
    size_t count = fread(values, sizeof values[0], BLOCK, stdin);
    while (count > 0U) {
        for (size_t i = 0U; i < count; i++) {
            results[i][0] = ahv_exp(values[i]);
            results[i][1] = ahv_sin(values[i]);
            results[i][2] = ahv_cos(values[i]);
            ahv_sin_cos(values[i], &results[i][3], &results[i][4]);
            results[i][5] = ahv_sqrt(values[i]);
            results[i][6] = ahv_recip(values[i]);
            results[i][7] = ahv_tan(values[i]);
            results[i][8] = ahv_asin(values[i]);
            results[i][9] = ahv_atan(values[i]);
            results[i][10] = ahv_tanh(values[i]);
            results[i][11] = ahv_ln(values[i]);
            results[i][12] = ahv_abs(values[i]);
            results[i][13] = ahv_atan2(values[i], values[count - 1U - i]);
            results[i][14] = ahv_powr(values[i], values[count - 1U - i]);
            results[i][15] = ahv_min(values[i], values[count - 1U - i]);
            results[i][16] = ahv_max(values[i], values[count - 1U - i]);
            results[i][17] = ahv_select(values[i], values[count - 1U - i], 1.0, values[i]);
        }
        if (fwrite(results, sizeof results[0], count, stdout) != count) {
            return 1;
        }
        count = fread(values, sizeof values[0], BLOCK, stdin);
    }
    return (ferror(stdin) != 0) || (fflush(stdout) != 0);
}
