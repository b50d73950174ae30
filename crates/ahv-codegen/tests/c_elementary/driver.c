/* Reads doubles from standard input and writes seven results of each to standard output, in the machine's byte order:
 * exp, sin, cos, both of sin_cos, sqrt, recip. */
#include "ahv_elementary.h"

#include <stdio.h>

#define BLOCK 4096
#define RESULTS 7

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
        }
        if (fwrite(results, sizeof results[0], count, stdout) != count) {
            return 1;
        }
        count = fread(values, sizeof values[0], BLOCK, stdin);
    }
    return (ferror(stdin) != 0) || (fflush(stdout) != 0);
}
